"""The command and the call from end to end on a small bench: is it faulty, of what, how large, where."""

import json
import re
from functools import cache, partial
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import small_bench
import yaml
from diagnosis_calibration import calibration
from scipy.stats import binom, kstest
from small_bench import POINTS, SECTORS, coarse_model

import swgsim as swg
from swgsim.dataset.faults import FAULTS
from swgsim.effects import EccentricWaveGenerator, GaugeGain
from swgsim.effects.library import named
from swgsim.gear.gear import Gear
from swgsim.identification import commission
from swgsim.identification.data.angle_zero import from_zero
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitting import fit
from swgsim.oracle.cells import Resolution
from swgsim.recordings.files.folder import write_folder
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin import diagnose_job, unit_diagnosis
from swgsim.twin.fault_posterior import Suspected

GEAR = yaml.safe_load((Path(__file__).parents[2] / "conf" / "gear" / "gear1.yaml").read_text())
pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
recorded = cache(partial(small_bench.recorded, Gear()))
SEARCHED = ["eccentric_wave_generator", "gauge_gain", "reduced_damping"]
COARSE = Resolution(
    nodes=5,
    severities={**dict.fromkeys(FAULTS, 12), "root_tooth_crack": 72},
    positions={"eccentric_wave_generator": 12, "tip_tooth_crack": 24},
    finer=4,
)


@pytest.fixture(scope="module", autouse=True)
def _small():
    """Fewer cells, and no pictures of the loop."""
    with coarse_model() as patch:
        patch.setattr("swgsim.identification.report.answer_figures.pictures", lambda *_: {})
        patch.setattr(unit_diagnosis, "SECTORS", SECTORS)
        patch.setattr(unit_diagnosis, "RESOLUTION", COARSE)
        yield


def choices(folder, **changes: object) -> dict:
    plain = {
        "recordings": str(folder / "faulty"), "commissioning": str(folder / "healthy"), "mapping": None,
        "commissioning_mapping": None, "gear": GEAR, "effects": [], "out": str(folder / "answer"), "prior": {},
        "false_alarms": 0.01, "costs": {}, "searched": SEARCHED, "library": [], "seed": 0,
    }  # fmt: skip
    return plain | changes


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Recordings of the healthy gear, and of the same gear with a fault."""
    place = tmp_path_factory.mktemp("bench")
    write_folder(place / "healthy", recorded(seed=1))
    write_folder(place / "faulty", recorded(EccentricWaveGenerator(3e-5, 1.0), seed=2))
    return place


@pytest.fixture(scope="module")
def faulty_and_unit(folder) -> tuple[swg.Diagnosis, swg.Unit]:
    """The diagnosis of the command, and the unit that it commissioned."""
    units: list[swg.Unit] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(unit_diagnosis, "commission", lambda *of, **how: units.append(commission(*of, **how)) or units[0])
        found = diagnose_job.run(choices(folder))
    return found, units[0]


@pytest.fixture(scope="module")
def faulty(faulty_and_unit) -> swg.Diagnosis:
    return faulty_and_unit[0]


@pytest.fixture(scope="module")
def unit(faulty_and_unit) -> swg.Unit:
    return faulty_and_unit[1]


def test_a_faulty_gear_is_named_with_size_and_position(faulty) -> None:
    r, theta = (faulty.report["fault"]["parameters"][name] for name in ("r", "theta"))
    assert faulty.report["verdict"] == "faulty"
    assert faulty.sentence.startswith("Faulty: an eccentric wave generator: ")
    assert faulty.report["probabilities"]["eccentric_wave_generator"] > 0.999
    assert r["ci95"][0] < 3e-5 < r["ci95"][1]
    assert r["ci95"][1] - r["ci95"][0] < 5e-6
    assert theta["ci95"][0] < 1.0 < theta["ci95"][1]
    assert theta["value"] == pytest.approx(1.0, abs=0.05)
    assert faulty.report["chance"] < 0.002
    assert faulty.report["lack_of_fit"]["chance"] > 0.01
    assert faulty.report["lack_of_fit_healthy"]["chance"] > 0.01
    assert len(faulty.report["recordings"]) == 2 * len(POINTS)
    assert sum(faulty.report["recordings"][0]["probabilities"].values()) == pytest.approx(1)


def test_the_page_answers_the_questions_of_a_workshop(folder, faulty) -> None:
    html = unescape((folder / "answer" / "page.html").read_text(encoding="utf-8"))
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))
    assert faulty.sentence in text
    assert re.search(r"What to do\? replace: 1(\.0)?; inspect: 1\.1; leave: 10 \(expected cost", text)
    asked = ("Is it faulty? yes : fewer than 0.2 % of healthy", "Of what, and how sure?", "How large?", "Where?")
    for question in asked:
        assert question in text
    assert re.search(r"direction from gauge s1, in the sense of rotation: 5\d° \(95 %: 5\d to \d\d\)", text)
    assert "What would settle it Check the wave generator: measure run-out" in text
    assert "None" not in text
    assert (folder / "answer" / "loop" / "page.html").is_file()
    assert json.loads((folder / "answer" / "diagnosis.json").read_text())["sentence"] == faulty.sentence


def test_a_healthy_gear_is_healthy_and_something_else_is_no_fault(unit) -> None:
    kinds = [named(each) for each in SEARCHED]
    healthy = swg.diagnose(recorded(seed=3), unit, effects=kinds)
    assert healthy.report["verdict"] == "healthy"
    assert healthy.sentence.startswith("No fault is seen: healthy with a probability of 0.9")
    assert healthy.report["of_healthy"] is None
    gain = swg.diagnose(recorded(GaugeGain(1, 0.03), seed=3), unit, effects=kinds)
    assert gain.report["verdict"] == "something_else"
    assert "Other finding: The model lacks a gauge gain of s1" in gain.sentence


def test_mistakes_are_named(folder, unit) -> None:
    with pytest.raises(ValueError, match=r"no healthy recordings: give commissioning=FOLDER"):
        diagnose_job.run(choices(folder, commissioning=None))
    with pytest.raises(ValueError, match=r"no recordings: give recordings=FOLDER"):
        diagnose_job.run(choices(folder, recordings=None))
    with pytest.raises(ValueError, match=r"recording .* is also in the commissioning"):
        diagnose_job.run(choices(folder, recordings=str(folder / "healthy")))
    with pytest.raises(ValueError, match=r"root_tooth_crak.*root_tooth_crack"):
        swg.diagnose((), unit, prior={"root_tooth_crak": 0.1})
    with pytest.raises(ValueError, match=r"healthy of the prior is 0, must be a finite number from 1e-09 to 1"):
        swg.diagnose((), unit, prior={"healthy": 0})
    with pytest.raises(ValueError, match=r"false_alarms of the diagnosis is 0, must be a finite number from 0.001"):
        swg.diagnose((), unit, false_alarms=0)


@pytest.fixture(scope="module")
def suspected(unit) -> Suspected:
    new = Measured.of(from_zero(recorded(seed=3), unit.zero))
    return Suspected.of(fit(new, unit), unit_diagnosis.partitions(), dict.fromkeys(CLASSES, 1 / len(CLASSES)))


@pytest.mark.parametrize("which", [slice(None), slice(0, 1)])
def test_faults_lie_where_their_posterior_says(suspected, which) -> None:
    """Simulation-based calibration: ranks are uniform, and classes as frequent as they are probable."""
    chosen = np.zeros(2 * len(POINTS), bool)
    chosen[which] = True
    table = calibration(suspected, chosen, 300, np.random.default_rng(1))
    ranks = table["below"].dropna()
    assert kstest(ranks, "uniform").pvalue > 1e-3
    assert ((ranks > 0.025) & (ranks < 0.975)).sum() > binom.ppf(1e-3, len(ranks), 0.95)
    p = table[list(CLASSES)].to_numpy()
    right = np.array(CLASSES)[p.argmax(axis=1)] == table["label"]
    expected = p.max(axis=1)
    assert abs(right.sum() - expected.sum()) < 3.5 * np.sqrt((expected * (1 - expected)).sum() + 1)


def test_false_alarms_are_as_frequent_as_said(suspected) -> None:
    chosen = np.ones(2 * len(POINTS), bool)
    rng = np.random.default_rng(2)
    chance = suspected.posterior_of(chosen, suspected.fitted.whole.drawn(rng, 400)).chance(rng)
    assert kstest(chance, "uniform").pvalue > 1e-3
    assert (chance <= 0.05).sum() < binom.ppf(0.999, 400, 0.05)
