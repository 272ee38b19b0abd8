"""The command and the two calls from end to end on a small bench: recordings in, the answer out."""

import json
import re
import shutil
from dataclasses import replace
from functools import partial
from html import unescape
from pathlib import Path

import matplotlib.figure
import numpy as np
import pytest
import small_bench
import yaml
from prepared_store import prepared
from small_bench import POINTS, coarse_model

from learn import tracking
from learn.commands.close_loop import record
from swgsim.common.outcome import NOTHING, Outcome
from swgsim.effects.eccentric_wave_generator import EccentricWaveGenerator
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.library import SEARCHED as LIBRARY_SEARCHED
from swgsim.effects.library import named
from swgsim.effects.line_between import FractionalOrder
from swgsim.effects.load_sharing import LoadSharing
from swgsim.effects.reduced_damping import ReducedDamping
from swgsim.effects.text import from_text
from swgsim.effects.thermal_growth import ThermalGrowth
from swgsim.gear.conditions import Conditions
from swgsim.identification import Unit, commission, identify
from swgsim.identification.calls import require_comparable, require_same_gear
from swgsim.identification.fit.unit import UNHEARD
from swgsim.identification.interharmonics.line_pattern import Part
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.report import close_loop as job
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.identification import Identification
from swgsim.identification.report.loop_input import _comparable
from swgsim.identification.report.next_experiment import RECORDINGS, SEPARATED, next_experiments
from swgsim.identification.report.open_questions import next_experiment
from swgsim.identification.report.report_fields import report
from swgsim.identification.report.sentence import MOST_NAMED, sentence
from swgsim.identification.search.screening import Score
from swgsim.jobs import settings
from swgsim.jobs.settings import gear
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.recording import Recording
from swgsim.recordings.recording_set import RecordingSet

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
CONF = Path(__file__).parents[2] / "conf"
GEAR = yaml.safe_load((CONF / "gear" / "gear1.yaml").read_text())
recorded = partial(small_bench.recorded, gear(GEAR))
SEARCHED = ["eccentric_wave_generator", "cam_form", "reduced_damping", "gauge_gain", "channel_skew", "sub_orders"]
HIDDEN = EccentricWaveGenerator(3e-5, 1.0)
PARTS = (
    Part(FractionalOrder(2e-3, pattern="in s2 alone", order=5.37), ("proportional to the load",)),
    Part(FractionalOrder(1e-3, pattern="in s0 alone", order=5.37), ()),
)
WHISTLE = Unnamed("order", 5.37, 1e-9, 100.0, 0.01, 10.0, PARTS)
KEYS = {
    "verdict", "sentence", "probability", "noise_floor", "calibrated", "effects", "small", "alternatives",
    "options", "error", "unknown", "next_experiment", "moved", "absorbed", "detectable", "scores", "commissioned",
    "structure", "learned", "discrepancy", "unheard", "zeros", "channels", "recordings", "defects", "seconds", "made",
}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _small_mesh():
    with coarse_model():
        yield


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Recordings with a hidden effect, and of the healthy gear before."""
    place = tmp_path_factory.mktemp("bench")
    for name, effects, seed in (("sick", (HIDDEN,), 2), ("healthy", (), 1)):
        write_folder(place / name, recorded(*effects, seed=seed))
    (place / "sick.json").write_text(json.dumps({"hidden": [{"eccentric_wave_generator": {"r": 3e-5, "theta": 1.0}}]}))
    return place


def choices(folders: Path, recordings: str, **changes: object) -> dict:
    plain = {
        "recordings": str(folders / recordings), "commissioning": str(folders / "healthy"), "mapping": None,
        "commissioning_mapping": None, "gear": GEAR, "effects": [], "out": str(folders / f"{recordings}-answer"),
        "searched": SEARCHED, "library": [], "truth": None, "interest": 0.2, "seed": 0,
    }  # fmt: skip
    return plain | changes


@pytest.fixture(scope="module")
def sick_and_unit(folders) -> tuple[Outcome, Unit]:
    """The answer of the command to recordings of the sick gear, and the unit that it commissioned."""
    units: list[Unit] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(job, "commission", lambda *given, **more: units.append(commission(*given, **more)) or units[0])
        outcome = job.run(choices(folders, "sick", truth=str(folders / "sick.json")))
    return outcome, units[0]


@pytest.fixture(scope="module")
def sick(sick_and_unit) -> Outcome:
    return sick_and_unit[0]


@pytest.fixture(scope="module")
def unit(sick_and_unit) -> Unit:
    return sick_and_unit[1]


@pytest.fixture
def _no_pictures(monkeypatch):
    monkeypatch.setattr("swgsim.identification.report.answer_figures.pictures", lambda *_: {})


@pytest.fixture(scope="module")
def healthy(unit) -> tuple[Identification, list[str]]:
    """The answer to recordings of a healthy gear, and the steps on the way."""
    steps: list[str] = []
    return identify(recorded(seed=3), unit, effects=[named(each) for each in SEARCHED], progress=steps.append), steps


def test_report_names_the_hidden_effect_with_its_size_and_evidence(folders, sick):
    def refuse(word: str) -> None:
        raise ValueError(f"{word} is not JSON")

    said = json.loads((folders / "sick-answer" / "report.json").read_text(), parse_constant=refuse)
    assert set(said) == KEYS | {"hidden"}
    (effect,) = said["effects"]
    r = effect["parameters"]["r"]
    assert said["verdict"] == "effect_found"
    assert said["sentence"].startswith("The model lacks an eccentric wave generator: ")
    assert re.search(r"\d+\.\d µm \(95 %: .* off centre, towards \d+° from gauge s1", said["sentence"])
    assert (effect["name"], effect["place"], r["unit"]) == ("eccentric_wave_generator", "wave generator", "m")
    assert r["ci95"][0] < HIDDEN.r < r["ci95"][1]
    assert effect["probability"] > 0.97
    assert effect["evidence"]["gain"] > 3
    assert said["probability"] >= 0.95 or len(said["alternatives"]) > 1
    first = said["options"][0]
    assert (first["effects"], first["regularities"], first["log_ratio"]) == (["eccentric_wave_generator"], [], 0)
    assert said["commissioned"]
    assert set(said["calibrated"]) >= {"k1", "b1", "gain of s0"}
    assert said["recordings"]["repeats"] == {"fewest": 2, "most": 2}
    assert said["made"]["commissioning"] == str(folders / "healthy")


def test_every_field_of_the_report_is_explained(sick):
    page = (Path(__file__).parents[2] / "docs" / "report_fields.md").read_text(encoding="utf-8")
    assert [name for name in sick.report if f"`{name}`" not in page] == []


def test_error_falls_to_the_noise_floor(sick):
    error = sick.report["error"]
    assert error["after"]["fit"] < 0.5 * error["before"]["fit"]
    assert error["after"]["fit"] < 3 * error["noise_floor"]
    assert set(error["per_channel"]) == {"n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4"}


def test_page_opens_with_the_sentence_and_folds_the_details(folders, sick):
    page = (folders / "sick-answer" / "page.html").read_text()
    first = re.search(r"<body>\s*<h1>(.*?)</h1>", page, re.DOTALL)
    assert first is not None
    assert unescape(first[1]) == sick.report["sentence"]
    summary, details = page.split('<h2 id="details">')
    assert summary.count("data:image/png;base64,") == 2  # the residual, and the probabilities
    assert page.count("data:image/png;base64,") == len(sick.pictures) >= 5
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    for fact in (
        "Effect that was hidden",
        "Check the wave generator: measure run-out",
        str(folders / "sick"),
        "eccentric wave",
    ):
        assert fact in summary
    assert details.count("<details") == details.count("</details>") > 7
    assert not re.search(r"\d(\.\d+)?e-0\d m\b", summary)


def test_effects_are_given_back_as_they_were_found(folders, sick):
    (found,) = from_text((folders / "sick-answer" / "effects.yaml").read_text(), "effects.yaml")
    (effect,) = sick.report["effects"]
    assert found == EccentricWaveGenerator(**{name: p["value"] for name, p in effect["parameters"].items()})


def test_the_answer_is_kept_as_a_run(folders, sick, tmp_path):
    sick = replace(sick, pictures=dict(list(sick.pictures.items())[:2]))
    runs = {"name": "local", "folder": str(prepared(tmp_path))}
    record(choices(folders, "sick") | {"source": None, "tracking": runs}, sick)
    store = tracking.local_store(str(tmp_path), "loop")
    (run,) = store.client.search_runs([store.experiment_id])
    said, kept = sick.report, run.data
    assert (run.info.run_name, run.info.status) == (said["verdict"], "FINISHED")
    assert (kept.tags["verdict"], kept.tags["sentence"]) == (said["verdict"], said["sentence"])
    assert kept.params["recordings"] == str(folders / "sick")
    for when in ("before", "after"):
        assert kept.metrics[f"error_{when}_heldout"] == said["error"][when]["heldout"]
    assert kept.metrics["eccentric_wave_generator/r"] == said["effects"][0]["parameters"]["r"]["value"]
    pictures = {each.path for each in store.client.list_artifacts(run.info.run_id, "figures")}
    assert pictures == {f"figures/{name}.png" for name in sick.pictures}
    assert len(tracking.table_of(store, run.info.run_id, "tables/scores.parquet")) == len(said["scores"])


@pytest.mark.slow
@pytest.mark.usefixtures("_no_pictures")
def test_an_effect_of_a_user_is_found_and_may_then_be_declared(unit, tmp_path, monkeypatch):
    """The one that docs/virtual_bench.md shows, hidden and searched by its import path."""
    docs = (CONF.parent / "docs" / "virtual_bench.md").read_text(encoding="utf-8")
    shown = re.search(r"```python\n# my_bench\.py\n(.*?)```", docs, re.DOTALL)
    assert shown is not None
    (tmp_path / "my_bench.py").write_text(shown[1])
    monkeypatch.syspath_prepend(tmp_path)
    softening = named("my_bench:Softening")
    soft, kinds = recorded(softening(0.02), seed=5), [*map(named, SEARCHED[1:4]), softening]
    found = identify(soft, unit, effects=kinds)
    (effect,) = found.report["effects"]
    share = effect["parameters"]["share"]
    assert effect["name"] == "my_bench:Softening"
    assert share["ci95"][0] < 0.02 < share["ci95"][1]
    table = found.table().set_index("parameter").loc["relative change"]
    assert (table["value"], table["unit"]) == (pytest.approx(100 * share["value"]), "%")
    found.save(tmp_path / "answer")
    declared = settings.effects(str(tmp_path / "answer" / "effects.yaml"))
    assert declared == (softening(share["value"]),)
    known = replace(unit, model=unit.model.plus(*declared))
    assert identify(soft, known, effects=kinds).verdict == NOTHING


def test_gauges_that_are_exchanged_against_the_commissioning_are_refused(unit):
    own = replace(unit, healthy=recorded(GaugeGain(1, 0.01), seed=1))
    exchanged = [
        replace(each, channels={**each.channels, "s1": each.channels["s3"], "s3": each.channels["s1"]})
        for each in recorded(GaugeGain(1, 0.01), seed=3)
    ]
    with pytest.raises(ValueError, match=r"recordings: .*\n- refuse: .* s1 s3: .*swap their columns"):
        identify(exchanged, own)


def test_nothing_is_missing_in_a_healthy_gear(healthy):
    found, steps = healthy
    said, printed = found.report, job.lines(found.report)
    assert (said["verdict"], said["effects"], said["unknown"]) == (NOTHING, [], None)
    assert said["probability"] > 0.9
    assert printed[0].startswith("Nothing is missing")
    names = ["error before", "error after", "noise floor", "detected from"]
    assert [line.split("  ")[0] for line in printed[1:]] == names
    assert re.search(r"eccentric wave generator \(\S+ µm\)", printed[-1])
    assert said["detectable"]["eccentric_wave_generator"]["value"] < HIDDEN.r
    assert said["error"]["before"] == said["error"]["after"]
    words = list(dict.fromkeys(step.split()[0] for step in steps))
    assert words == ["searching", "fitting", "screening", "p-values", "describing", "report:"]


def test_results_show_themselves(unit, healthy, sick):
    found, _ = healthy
    assert "commissioned on 8 recordings of 'A'" in repr(unit)
    assert repr(found).startswith("Identification of 'A' from 8 recordings: Nothing is missing")
    assert found._repr_html_().startswith("<b>Identification of")
    assert found.table().empty
    assert isinstance(found.plot_residual(), matplotlib.figure.Figure)
    with pytest.raises(ValueError, match="recordings has no s0, which the unit was commissioned with"):
        identify([_without(each, "s0") for each in unit.healthy], unit)


def test_an_interrupted_command_says_that_it_keeps_nothing(folders, monkeypatch):
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("swgsim.identification.report.loop_input.read_recordings", interrupted)
    with pytest.raises(KeyboardInterrupt, match="nothing is kept"):
        job.run(choices(folders, "sick", out=str(folders / "interrupted")))


@pytest.fixture(scope="module")
def found() -> Answer:
    """The answer to recordings of one operating point without commissioning."""
    return identify(
        recorded(seed=4, points=POINTS[2:3]), gear(GEAR), effects=[LoadSharing, ReducedDamping, ThermalGrowth]
    ).answer


def test_ripple_that_is_not_used_is_reported(found):
    before, layout = found.decision.before, found.decision.before.measured.layout
    inflation = np.where((layout.channel == "T_out") & (layout.order > 0), UNHEARD, 1.0)
    unused = replace(before, unit=replace(before.unit, inflation=inflation))
    said = report(replace(found, decision=replace(found.decision, before=unused)), ())
    assert (said["unheard"], said["discrepancy"]) == (["T_out"], {})


def test_untestable_effects_are_named_where_nothing_is_missing(found):
    scores = found.decision.scores

    def said(*absorbed: Score) -> str:
        return sentence(replace(found, absorbed=absorbed), ())

    assert found.verdict == NOTHING
    plain = said().removesuffix(".")
    assert "cannot test" not in plain
    titles = [score.hypothesis.kind.title() for score in scores]
    assert said(*scores[:2]) == f"{plain}; these recordings cannot test {titles[0]}, {titles[1]}."
    many = scores[:1] * (MOST_NAMED + 3)
    expected = f"{plain}; these recordings cannot test {', '.join(titles[:1] * MOST_NAMED)} and 3 more."
    assert said(*many) == expected


def test_next_experiment_is_named_where_one_helps(found):
    """Load sharing shows at another speed, and so does growth with heat, for which the gear need not be warmed; less
    damping is what b1 of the series may be as well, at any point.
    """
    experiments = {
        each.between[0].split(" of ")[0]: each
        for each in next_experiments(replace(found, absorbed=found.decision.scores))
    }
    helpful, helpless = experiments["load sharing"], experiments["reduced damping"]
    assert helpful.recordings in RECORDINGS
    assert helpful.separation >= SEPARATED
    assert helpful.situation.point != POINTS[2]
    assert helpful.situation.conditions == Conditions()
    growth = experiments["thermal growth"]
    assert growth.separation >= SEPARATED
    assert growth.situation.conditions == Conditions()
    warm = replace(growth, situation=replace(growth.situation, conditions=Conditions(45.0)))
    assert "with the gear at 45 °C" in str(warm)
    assert helpless.recordings is None
    assert "no recordings on this bench can detect reduced damping" in str(helpless)
    assert next_experiments(replace(found, absorbed=())) == ()
    # Without commissioning, an unknown remainder may have been there from the start.
    assert next_experiment((), found) is None
    assert "commissioning=FOLDER" in next_experiment((), replace(found, unnamed=(WHISTLE,)))["words"]


@pytest.mark.usefixtures("_no_pictures")
def test_unknown_lines_are_reported_and_given_back_as_effects(found, tmp_path):
    """With the declared effects of their kind; the strongest part leads."""
    whistling = replace(found, unnamed=(WHISTLE,))
    said = report(whistling, [LoadSharing])
    unknown = said["unknown"]
    assert (unknown["orders"], unknown["pattern"], unknown["law"]) == ([5.37], "in s2 alone", "constant")
    (line,) = unknown["lines"]
    assert (line["kind"], line["at"], line["parts"][0]["rivals"]) == ("order", 5.37, ["proportional to the load"])
    assert line["words"] in unknown["words"]
    assert unknown["effects"] == [
        {"fractional_order": {"amplitude": a, "phase": 0.0, "pattern": p, "law": "constant", "order": 5.37}}
        for a, p in ((2e-3, "in s2 alone"), (1e-3, "in s0 alone"))
    ]
    Identification(whistling, said).save(tmp_path)
    assert from_text((tmp_path / "effects.yaml").read_text(), "answer") == tuple(p.effect for p in WHISTLE.parts)


def test_recordings_that_do_not_belong_together_are_refused(folders):
    recordings = recorded(seed=1, points=POINTS[:1])
    with pytest.raises(ValueError, match="gear 'A', those of the commissioning of 'B': commission the same gear"):
        require_same_gear(recordings, [replace(each, gear="B") for each in recordings])
    with pytest.raises(ValueError, match="folder has no phi_in_rad"):
        require_comparable((replace(recordings[0], channels={"s1": recordings[0].channels["s1"]}),), "folder")
    with pytest.raises(ValueError, match="folder holds recordings of the gears A, B"):
        require_comparable((recordings[0], replace(recordings[1], gear="B")), "folder")
    with pytest.raises(ValueError, match="no truth of swg record"):
        job.run(choices(folders, "sick", truth=str(CONF / "gear" / "gear1.yaml")))


def test_a_message_about_a_file_says_of_which_folder(folders, tmp_path):
    shutil.copytree(folders / "healthy", tmp_path / "spoiled")
    (tmp_path / "spoiled" / "recording_0001.csv").write_text("t_s\n")
    of_folder = f"commissioning={tmp_path / 'spoiled'}: recording_0001.csv, row 2: found names without rows"
    for folder, message in (("spoiled", of_folder), ("lost", f"commissioning={tmp_path / 'lost'}: found nothing")):
        with pytest.raises(ValueError, match=message):
            job.run(choices(folders, "sick", commissioning=str(tmp_path / folder)))


@pytest.mark.parametrize("name", ["regularity", "fractional_order", "fixed_frequency"])
def test_descriptions_of_the_unknown_are_not_searched(name):
    with pytest.raises(ValueError, match=f"{name} cannot be searched"):
        job.library({"searched": ["cam_form", name], "library": []})


def test_names_are_a_list_or_a_text_with_commas():
    for searched, library in (
        ("cam_form, gauge_gain", "reduced_damping"),
        (["cam_form", "gauge_gain"], ["reduced_damping"]),
    ):
        kinds = job.library({"searched": searched, "library": library})
        assert [kind.name() for kind in kinds] == ["cam_form", "gauge_gain", "reduced_damping"]
    assert job.library({"searched": None, "library": None}) == LIBRARY_SEARCHED


@pytest.mark.parametrize("out", ["sick.json", "sick.json/answer", "x" * 300])
def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_read(folders, out):
    with pytest.raises(OSError, match=f"{out} was not written; choose another folder"):
        job.run(choices(folders, "lost", out=str(folders / out)))


def test_a_recording_does_not_commission_itself():
    """Its effects would be learned as healthy, and nothing found missing."""
    one, *others = recorded(seed=1, points=POINTS[:1])
    copy = replace(_without(one, "s0"), name="renamed")
    with pytest.raises(ValueError, match=rf"recording renamed is also in the commissioning, as {one.name}: .*healthy"):
        require_same_gear([copy], [one, *others])


def test_channels_that_only_one_side_has_are_left_out():
    recordings, others = (recorded(seed=seed, points=POINTS[:1]) for seed in (1, 2))
    healthy = _comparable(RecordingSet(recordings), RecordingSet(tuple(_without(each, "s0") for each in others)))
    assert "s0" not in healthy[0].channels
    assert list(
        _comparable(RecordingSet(tuple(_without(r, "s1") for r in recordings)), RecordingSet(others))[0].channels
    ) == [name for name in others[0].channels if name != "s1"]


def _without(recording: Recording, channel: str) -> Recording:
    return replace(recording, channels={name: v for name, v in recording.channels.items() if name != channel})
