"""The public interface gives what the chain gives, and results that show, tabulate and save themselves."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import learn
import swgsim as swg
from swgsim.chain import Run, simulate_runs

POINT = swg.OperatingPoint(n_in_rpm=2000, T_out=39)
SHORT = swg.Window(samples=320)  # a little more than a revolution
CRACK = swg.effects.RootToothCrack(0.03, theta=1.0)


@pytest.fixture(scope="module")
def cracked() -> swg.SimulatedRun:
    return swg.simulate(swg.Gear(), POINT, CRACK, window=SHORT, sectors=60)


def test_every_public_name_exists() -> None:
    for module in (swg, learn):
        assert all(getattr(module, name) is not None for name in module.__all__)


def test_importing_is_light() -> None:
    program = "import sys, swgsim, learn; print(sorted({'torch', 'scipy', 'mlflow', 'matplotlib'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout == "[]\n"


def test_one_run_is_a_run_of_the_batched_chain(cracked: swg.SimulatedRun) -> None:
    batch = simulate_runs([Run(swg.Gear(), POINT), Run(swg.Gear(), POINT, (CRACK,))], SHORT, 60)
    np.testing.assert_allclose(cracked.signals, batch.signals[1], rtol=1e-9, atol=1e-15)
    assert cracked.efficiency == pytest.approx(batch.efficiency[1], rel=1e-9)


def test_a_result_shows_itself(cracked: swg.SimulatedRun) -> None:
    assert repr(cracked).startswith("<SimulatedRun gear 1, 2000 rpm, 39 N m: root tooth crack")
    assert "data:image/png" in cracked._repr_html_()
    assert len(cracked.plot(compare=cracked).axes) == 5


def test_a_gear_shows_what_it_is_in_one_line_and_in_a_notebook() -> None:
    gear = swg.Gear.load("gear2")
    assert len(repr(gear)) < 200
    assert "k1 5680 N m/rad" in repr(gear)
    assert "<th>w0</th><td>215.9 µm</td>" in gear._repr_html_()


def test_a_saved_table_is_read_again(cracked: swg.SimulatedRun, tmp_path: Path) -> None:
    cracked.save(tmp_path / "run.csv")
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "run.csv"), cracked.table())


def test_a_result_is_a_recording(cracked: swg.SimulatedRun) -> None:
    recording = cracked.recording("a")
    assert (recording.name, recording.point, set(recording.channels)) == ("a", POINT, set(cracked.channels))


def test_gauges_need_a_unit_and_joints_do_not(cracked: swg.SimulatedRun) -> None:
    with pytest.raises(ValueError, match="need a unit"):
        swg.identify([cracked.recording()])  # type: ignore[call-overload]


def test_a_gear_is_loaded_with_what_it_is_based_on() -> None:
    gear = swg.Gear.load(Path(__file__).parents[2] / "conf" / "gear" / "gear2.yaml")
    assert (gear.number, gear.transmission.b1, gear.transmission.N) == (2, 0.624, 100)


@pytest.mark.parametrize(
    ("text", "message"),
    [("number: 0", "number"), ("- 1", "holds list"), ("numbr: 1", "numbr"), ("a: [", "no YAML")],
)
def test_a_gear_file_with_a_mistake_is_named(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(ValueError, match=f"mine.yaml.*{message}"):
        swg.Gear.load(path)
    with pytest.raises(ValueError, match=r"other\.yaml: not found"):
        swg.Gear.load(tmp_path / "other.yaml")
