"""The command from end to end on a small bench: recordings in, the answer out."""

import json
import re
import shutil
from dataclasses import replace
from functools import partial
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import yaml
from close_loop import record

from learn import tracking
from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Instruments, Sessions, record_sessions
from swgsim.chain.chain import simulate_turns
from swgsim.common.outcome import NOTHING
from swgsim.effects.base import Effect
from swgsim.effects.eccentric_wave_generator import EccentricWaveGenerator
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.library import SEARCHED as LIBRARY_SEARCHED
from swgsim.effects.library import named
from swgsim.effects.line_between import FractionalOrder
from swgsim.effects.load_sharing import LoadSharing
from swgsim.effects.reduced_damping import ReducedDamping
from swgsim.effects.text import from_text
from swgsim.effects.thermal_growth import ThermalGrowth
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data import model
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.unit import UNHEARD, Unit
from swgsim.identification.interharmonics.line_pattern import Part
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.report import close_loop as job
from swgsim.identification.report.answer import MOST_NAMED, Answer, answer
from swgsim.identification.report.next_experiment import RECORDINGS, SEPARATED, next_experiments
from swgsim.identification.report.open_questions import next_experiment
from swgsim.identification.report.report_fields import report
from swgsim.identification.search.screening import Score
from swgsim.jobs import settings
from swgsim.jobs.settings import gear
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.recording import Recording

PARTS = (
    Part(FractionalOrder(2e-3, pattern="in s2 alone", order=5.37), ("proportional to the load",)),
    Part(FractionalOrder(1e-3, pattern="in s0 alone", order=5.37), ()),
)
WHISTLE = Unnamed("order", 5.37, 1e-9, 100.0, 0.01, 10.0, PARTS)
pytestmark = pytest.mark.end_to_end
CONF = Path(__file__).parents[2] / "conf"
GEAR = yaml.safe_load((CONF / "gear" / "gear1.yaml").read_text())
SECTORS = 40
POINTS = tuple(OperatingPoint(n, T) for n in (2000.0, 4000.0) for T in (10.0, 70.0))
SEARCHED = ["eccentric_wave_generator", "cam_form", "reduced_damping", "gauge_gain", "channel_skew", "sub_orders"]
HIDDEN = EccentricWaveGenerator(3e-5, 1.0)
KEYS = {
    "verdict", "sentence", "noise_floor", "calibrated", "effects", "rejected", "error", "unknown", "next_experiment",
    "moved", "absorbed", "detectable", "scores", "commissioned", "structure", "learned", "less_certain", "unheard",
    "zeros", "channels", "recordings", "defects", "seconds",
}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _small_mesh():
    """The model on the mesh of the bench, which is a small one here."""
    with pytest.MonkeyPatch.context() as patch:
        coarse = partial(simulate_turns, sectors=SECTORS)
        patch.setattr(
            model, "simulate_turns", lambda runs, revolutions, points, sectors: coarse(runs, revolutions, points)
        )
        yield


def recorded(*effects: Effect, seed: int, points: tuple[OperatingPoint, ...] = POINTS) -> tuple[Recording, ...]:
    plan = Sessions(points, repeats=2, revolutions=5)
    # Five revolutions are too few to tell slow noise of an amplifier from lines between the orders.
    still = Instruments(wander=0.0)
    return record_sessions(
        gear(GEAR), effects, plan, Bench(), seed=seed, window=Window(), sectors=SECTORS, name="A", instruments=still
    )


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Recordings with and without a hidden effect, and of the healthy gear before."""
    place = tmp_path_factory.mktemp("bench")
    for name, effects, seed in (("sick", (HIDDEN,), 2), ("sound", (), 3), ("healthy", (), 1)):
        write_folder(place / name, recorded(*effects, seed=seed))
    (place / "sick.json").write_text(json.dumps({"hidden": [{"eccentric_wave_generator": {"r": 3e-5, "theta": 1.0}}]}))
    return place


def choices(folders: Path, recordings: str, **changes: object) -> dict:
    plain = {
        "recordings": str(folders / recordings), "commissioning": str(folders / "healthy"), "mapping": None,
        "commissioning_mapping": None,
        "gear": GEAR, "effects": [], "out": str(folders / f"{recordings}-answer"), "searched": SEARCHED, "library": [],
        "truth": None, "seed": 0,
    }  # fmt: skip
    return plain | changes


@pytest.fixture(scope="module")
def sick(folders):
    """The answer to recordings of the sick gear."""
    return job.run(choices(folders, "sick", truth=str(folders / "sick.json")))


def read(folders: Path, name: str) -> dict:
    def refuse(word: str) -> None:
        raise ValueError(f"{word} is no JSON")

    return json.loads((folders / name / "report.json").read_text(), parse_constant=refuse)


def test_report_names_the_hidden_effect_with_its_size_and_evidence(folders, sick):
    said = read(folders, "sick-answer")
    assert set(said) == KEYS | {"hidden"}
    (effect,) = said["effects"]
    r = effect["parameters"]["r"]
    assert said["verdict"] == "effect_found"
    assert (effect["name"], effect["place"], r["unit"]) == ("eccentric_wave_generator", "wave generator", "m")
    assert r["ci95"][0] < HIDDEN.r < r["ci95"][1]
    assert effect["evidence"]["heldout_gain"] > 3
    assert said["commissioned"]
    assert set(said["calibrated"]) >= {"k1", "b1", "gain of s0"}
    assert said["recordings"]["repeats"] == {"fewest": 2, "most": 2}


def test_error_falls_to_the_noise_floor(sick):
    error = sick.report["error"]
    assert error["after"]["fit"] < 0.5 * error["before"]["fit"]
    assert error["after"]["fit"] < 3 * error["noise_floor"]
    assert set(error["per_channel"]) == {"n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"}


def test_page_opens_with_the_sentence_and_holds_all_it_needs(folders, sick):
    page = (folders / "sick-answer" / "page.html").read_text()
    first = re.search(r"<body>\s*<h1>(.*?)</h1>", page, re.DOTALL)
    assert first is not None
    assert unescape(first[1]) == sick.report["sentence"]
    assert page.count("data:image/png;base64,") == len(sick.figures) >= 4
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    assert "Effect that was hidden" in page


def test_effects_are_given_back_as_they_were_found(folders, sick):
    (found,) = from_text((folders / "sick-answer" / "effects.yaml").read_text(), "effects.yaml")
    (effect,) = sick.report["effects"]
    assert isinstance(found, EccentricWaveGenerator)
    assert {name: p["value"] for name, p in effect["parameters"].items()} == {
        "r": found.r,
        "theta": found.theta,
        "unequal": found.unequal,
    }


def test_the_answer_is_kept_as_a_run(folders, sick, tmp_path):
    record(choices(folders, "sick") | {"source": None, "tracking": {"name": "local", "folder": str(tmp_path)}}, sick)
    store = tracking.local_store(str(tmp_path), "loop")
    (run,) = store.client.search_runs([store.experiment_id])
    said, kept = sick.report, run.data
    assert (run.info.run_name, run.info.status) == (said["verdict"], "FINISHED")
    assert (kept.tags["verdict"], kept.tags["sentence"]) == (said["verdict"], said["sentence"])
    assert kept.params["recordings"] == str(folders / "sick")
    for when in ("before", "after"):
        assert kept.metrics[f"error_{when}_heldout"] == said["error"][when]["heldout"]
    assert kept.metrics["eccentric_wave_generator/r"] == said["effects"][0]["parameters"]["r"]["value"]
    figures = {each.path for each in store.client.list_artifacts(run.info.run_id, "figures")}
    assert figures == {f"figures/{name}.png" for name in sick.figures}
    assert len(tracking.table_of(store, run.info.run_id, "tables/scores.parquet")) == len(said["scores"])


def test_an_effect_of_a_user_is_found_and_may_then_be_declared(folders, tmp_path, monkeypatch):
    """The one that docs/recording.md shows, hidden and searched by its import path."""
    docs = (CONF.parent / "docs" / "recording.md").read_text(encoding="utf-8")
    shown = re.search(r"```python\n# my_bench\.py\n(.*?)```", docs, re.DOTALL)
    assert shown is not None
    (tmp_path / "my_bench.py").write_text(shown[1])
    monkeypatch.syspath_prepend(tmp_path)
    softening = named("my_bench:Softening")
    write_folder(folders / "soft", recorded(softening(0.02), seed=5))
    (effect,) = job.run(choices(folders, "soft", library=["my_bench:Softening"])).report["effects"]
    share = effect["parameters"]["share"]
    assert effect["name"] == "my_bench:Softening"
    assert share["ci95"][0] < 0.02 < share["ci95"][1]
    written = str(folders / "soft-answer" / "effects.yaml")
    assert settings.effects(written) == (softening(share["value"]),)
    assert job.run(choices(folders, "soft", effects=written)).report["verdict"] == NOTHING


def test_gauges_that_are_exchanged_against_the_commissioning_are_refused(folders):
    exchanged = [
        replace(each, channels={**each.channels, "s1": each.channels["s3"], "s3": each.channels["s1"]})
        for each in recorded(GaugeGain(1, 0.01), seed=3)
    ]
    write_folder(folders / "exchanged", exchanged)
    write_folder(folders / "own", recorded(GaugeGain(1, 0.01), seed=1))
    with pytest.raises(ValueError, match=r"exchanged: .*\n- refuse: .* s1 s3: .*swap their columns"):
        job.run(choices(folders, "exchanged", commissioning=str(folders / "own")))


def test_nothing_is_missing_in_a_sound_gear(folders, capsys):
    said = job.run(choices(folders, "sound")).report
    printed = capsys.readouterr().out.splitlines()
    assert (said["verdict"], said["effects"], said["unknown"]) == (NOTHING, [], None)
    assert printed[0].startswith("Nothing is missing")
    assert [line.split("  ")[0] for line in printed[1:]] == [
        "error before",
        "error after",
        "noise floor",
        "effect found",
        "would be seen",
    ]
    assert "eccentric wave generator (r " in printed[-1]
    assert said["detectable"]["eccentric_wave_generator"]["value"] < HIDDEN.r
    assert said["error"]["before"] == said["error"]["after"]


@pytest.fixture(scope="module")
def found() -> Answer:
    """The answer to recordings of one operating point of a gear never seen."""
    unit = Unit(model.Model(gear(GEAR)))
    return answer(recorded(seed=4, points=POINTS[2:3]), unit, [LoadSharing, ReducedDamping, ThermalGrowth])


def test_what_is_not_listened_to_is_said(found):
    before, layout = found.closed.before, found.closed.before.measured.layout
    heard = np.where((layout.channel == "T_out") & (layout.order > 0), UNHEARD, 1.0)
    heard[(layout.channel == "s1") & (layout.order == 4)] = 5.0
    deaf = replace(before, unit=replace(before.unit, inflation=heard))
    said = report(replace(found, closed=replace(found.closed, before=deaf)), ())
    assert (said["unheard"], said["less_certain"]) == (["T_out"], {"s1": [4]})


def test_what_cannot_be_decided_is_named_where_nothing_is_missing(found):
    scores = found.closed.scores

    def ends(*absorbed: Score) -> str:
        return replace(found, verdict=NOTHING, absorbed=absorbed).sentence.partition(" stands out of it")[2]

    titles = [score.hypothesis.kind.title() for score in scores]
    beginning = "; cannot be decided, as these recordings absorb them: "
    assert ends() == "."
    assert ends(*scores[:2]) == f"{beginning}{titles[0]}, {titles[1]}."
    many = scores[:1] * (MOST_NAMED + 3)
    assert ends(*many) == f"{beginning}{', '.join(titles[:1] * MOST_NAMED)} and 3 more."


def test_next_experiment_is_named_where_one_helps(found):
    """Load sharing shows at another speed, and so does growth with heat, for which the gear need not be warmed; less
    damping is what b1 of the series may be as well, at any point.
    """
    asked = replace(found, absorbed=found.closed.scores)
    experiments = {each.between[0].split(" of ")[0]: each for each in next_experiments(asked)}
    helpful, helpless = experiments["load sharing"], experiments["reduced damping"]
    assert helpful.recordings in RECORDINGS
    assert helpful.separation >= SEPARATED
    assert helpful.situation.point != POINTS[2]
    assert helpful.situation.conditions == Conditions()
    growth = experiments["thermal growth"]
    assert growth.separation >= SEPARATED
    assert growth.situation.conditions == Conditions()
    warm = replace(growth, situation=replace(growth.situation, conditions=Conditions(45.0)))
    assert "with the gear at 45 degC" in str(warm)
    assert helpless.recordings is None
    assert "no recording on the bench tells reduced damping" in str(helpless)
    assert next_experiments(replace(found, absorbed=())) == ()
    # What is unknown in a gear never commissioned may be what it has always had.
    assert next_experiment((), found) is None
    assert "commissioning=FOLDER" in next_experiment((), replace(found, unnamed=(WHISTLE,)))["words"]


def test_lines_that_nothing_explains_are_reported_and_given_back_as_effects(found, tmp_path):
    """With the declared effects of their kind; the strongest part leads."""
    whistling = replace(found, unnamed=(WHISTLE,))
    said = report(whistling, [LoadSharing], (), (), 1.0)
    unknown = said["unknown"]
    assert (unknown["orders"], unknown["pattern"], unknown["law"]) == ([5.37], "in s2 alone", "constant")
    (line,) = unknown["lines"]
    assert (line["kind"], line["at"], line["parts"][0]["rivals"]) == ("order", 5.37, ["proportional to the load"])
    assert line["words"] in unknown["words"]
    assert unknown["effects"] == [
        {"fractional_order": {"amplitude": a, "phase": 0.0, "pattern": p, "law": "constant", "order": 5.37}}
        for a, p in ((2e-3, "in s2 alone"), (1e-3, "in s0 alone"))
    ]
    job.write(tmp_path, whistling, said)
    assert from_text((tmp_path / "effects.yaml").read_text(), "answer") == tuple(p.effect for p in WHISTLE.parts)


def test_recordings_that_do_not_belong_together_are_refused(folders, tmp_path):
    other = tuple(replace(each, gear="B") for each in recorded(seed=1, points=POINTS[:1]))
    write_folder(tmp_path / "other", other)
    with pytest.raises(ValueError, match="gear 'A', those of the commissioning of 'B': commission the same gear"):
        job.run(choices(folders, "sound", commissioning=str(tmp_path / "other")))
    bare = tuple(replace(each, channels={"s1": each.channels["s1"]}) for each in other)
    write_folder(tmp_path / "bare", bare)
    with pytest.raises(ValueError, match="has no phi_in_rad"):
        job.run(choices(tmp_path, "sound") | {"recordings": str(tmp_path / "bare")})
    with pytest.raises(ValueError, match=r"no truth of swg record"):
        job.run(choices(folders, "sound", truth=str(CONF / "gear" / "gear1.yaml")))


def test_a_message_about_a_file_says_of_which_folder(folders, tmp_path):
    shutil.copytree(folders / "healthy", tmp_path / "spoiled")
    (tmp_path / "spoiled" / "recording_0001.csv").write_text("t_s\n")
    of_folder = f"commissioning={tmp_path / 'spoiled'}: recording_0001.csv, row 2: found a header without rows"
    for folder, message in (("spoiled", of_folder), ("lost", f"commissioning={tmp_path / 'lost'}: found nothing")):
        with pytest.raises(ValueError, match=message):
            job.run(choices(folders, "sick", commissioning=str(tmp_path / folder)))


@pytest.mark.parametrize("name", ["regularity", "fractional_order", "fixed_frequency"])
def test_what_a_loop_writes_for_the_unknown_is_not_searched_for(name):
    with pytest.raises(ValueError, match=f"{name} cannot be searched for"):
        job.library({"searched": ["cam_form", name], "library": []})


@pytest.mark.parametrize("searched", ["cam_form, gauge_gain", ["cam_form", "gauge_gain"]])
@pytest.mark.parametrize("library", ["reduced_damping", ["reduced_damping"]])
def test_names_are_a_list_or_a_text_with_commas(searched, library):
    kinds = job.library({"searched": searched, "library": library})
    assert [kind.name() for kind in kinds] == ["cam_form", "gauge_gain", "reduced_damping"]
    assert job.library({"searched": None, "library": None}) == LIBRARY_SEARCHED


@pytest.mark.parametrize("out", ["sick.json", "sick.json/answer", "x" * 300])
def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_read(folders, out):
    with pytest.raises(OSError, match=f"{out} was not written; choose another folder"):
        job.run(choices(folders, "lost", out=str(folders / out)))


def test_a_recording_does_not_commission_itself(folders, tmp_path):
    """All that it shows would be learned as healthy, and nothing found missing."""
    with pytest.raises(ValueError, match=r"is in both recordings=.* and commissioning=.*of the healthy state"):
        job.run(choices(folders, "sick", commissioning=str(folders / "sick")))
    healthy, *others = recorded(seed=1, points=POINTS[:1])
    copy = replace(healthy, name="renamed", channels={n: v for n, v in healthy.channels.items() if n != "s0"})
    with pytest.raises(ValueError, match=f"recording renamed is in both .* there as {healthy.name}"):
        job._alike([copy], [healthy, *others])


def test_channels_that_only_one_side_has_are_left_out(folders):
    recordings, others = (recorded(seed=seed, points=POINTS[:1]) for seed in (1, 2))
    fewer = tuple(replace(r, channels={n: v for n, v in r.channels.items() if n != "s0"}) for r in others)
    one, other = job._alike(recordings, fewer)
    assert Measured.of(one).layout == Measured.of(other).layout
    assert "s0" not in one[0].channels
