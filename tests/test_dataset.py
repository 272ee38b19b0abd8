"""Data sets: reproducible, resumable after a kill, independent of the number of workers."""

import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from chain_fixtures import small_plan

from swgsim import plan as plans
from swgsim import storage
from swgsim.bench import Bench
from swgsim.dataset import disturb, generate
from swgsim.disturbance import Disturbance
from swgsim.population import Population
from swgsim.record import record


def nothing(_: int) -> None:
    """No progress bar."""


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("data") / "clean.h5"
    generate(small_plan(), path, 1, nothing)
    return path


def test_grid_is_complete(clean: Path) -> None:
    table = storage.read(clean).table
    samples = table[~table["reference"]]
    assert len(table) == len(small_plan()) == 2 * 2 * (2 + 6 * 2)
    assert (samples.groupby(["gear", "label", "n_in_rpm"], observed=True).size() == 2).all()
    assert (table[table["reference"]]["label"] == "healthy").all()
    assert table["seed"].is_unique


def test_same_bytes_with_one_or_two_workers(clean: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    again = tmp_path / "clean.h5"
    generate(small_plan(), again, 2, nothing)
    assert again.read_bytes() == clean.read_bytes()


def test_a_killed_run_resumes_to_the_same_bytes(tmp_path: Path) -> None:
    """Killed with -9 while blocks are being made; the second run only makes what is missing."""
    program = (
        "import sys; sys.path[:0] = ['tests']\n"
        "from pathlib import Path\n"
        "from chain_fixtures import small_plan\n"
        "from swgsim import dataset, plan\n"
        "plan.BLOCK = 4\n"
        "report = lambda n: print(n, flush=True)\n"
        "dataset.generate(small_plan(), Path(sys.argv[1]), 1, report)\n"
    )
    root = Path(__file__).parent.parent
    command = [sys.executable, "-c", program]
    whole, killed = tmp_path / "whole.h5", tmp_path / "killed.h5"
    subprocess.run([*command, str(whole)], cwd=root, check=True, capture_output=True)
    with subprocess.Popen([*command, str(killed)], cwd=root, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for _ in range(4):
            process.stdout.readline()
        process.send_signal(signal.SIGKILL)
    assert not killed.exists()
    parts = list(tmp_path.glob(".killed.h5.*.parts/*.npz"))
    assert parts
    kept = {part: part.stat().st_mtime_ns for part in parts}
    resumed = subprocess.run([*command, str(killed)], cwd=root, check=True, capture_output=True, text=True)
    assert int(resumed.stdout.split()[0]) == 4 * len(kept)
    assert killed.read_bytes() == whole.read_bytes()
    assert not list(tmp_path.glob(".*"))


def test_parts_of_other_choices_are_not_mixed_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plans, "BLOCK", 8)
    path = tmp_path / "a.h5"
    other = tmp_path / ".a.h5.0123456789ab.parts"
    other.mkdir()
    (other / "000000.npz").write_bytes(b"parts of another configuration")
    generate(small_plan(), path, 1, nothing)
    assert len(storage.read(path)) == len(small_plan())
    assert (other / "000000.npz").exists()


def test_disturbed_is_clean_plus_equation_10(clean: Path, tmp_path: Path) -> None:
    path = tmp_path / "disturbed.h5"
    amplitude = 1e-3
    disturb(clean, path, Disturbance(amplitude, 2e-3), "", nothing)
    before, after = storage.read(clean), storage.read(path)
    added = after.signals.astype(float) - before.signals
    assert after.table.equals(before.table)
    assert 0 < np.abs(added).max() <= 2e-3 + 4 * amplitude + 1e-6
    # No recording and no sensor shares its disturbance with another one.
    assert len(np.unique(added.mean(axis=2).round(9))) == added.shape[0] * added.shape[1]


def test_equation_10_has_the_orders_it_says() -> None:
    time_s = np.arange(14400) / 10e3
    added = Disturbance(1.0, 1.0).draw(np.random.default_rng(3), 2, 2000, time_s)
    lines = np.abs(np.fft.rfft(added[0])) / len(time_s)
    orders = np.fft.rfftfreq(len(time_s), 1e-4) / (2000 / 60)
    np.testing.assert_allclose(sorted(orders[np.argsort(lines)[-5:]]), [0, 1 / 4, 1 / 3, 1 / 2, 1], atol=1e-9)
    assert np.sort(lines)[-6] < 1e-10


def test_bench_varies_what_clean_repeats() -> None:
    plan = small_plan()
    cases = [c for c in plan.cases((0, 0)) if c.variant.label == "healthy"][:8]
    clean, bench = record(plan, cases), record(replace(plan, bench=Bench()), cases)
    assert len(np.unique(clean.signals[:, 1, 0])) == 2  # one value for each operating point
    assert len(np.unique(bench.signals[:, 1, 0])) == len(cases)
    assert np.isfinite(bench.table["temperature_c"]).all()
    assert clean.table["temperature_c"].isna().all()
    relative = bench.table["efficiency"] / clean.table["efficiency"] - 1
    assert 0 < relative.abs().max() < 0.3


def test_a_silent_bench_records_the_clean_signals() -> None:
    silent = Bench(*[0.0] * 7, 25.0, *[0.0] * 6)
    plan = small_plan()
    cases = plan.cases((0, 0))[:6]
    np.testing.assert_allclose(
        record(replace(plan, bench=silent), cases).signals, record(plan, cases).signals, atol=1e-7
    )


def test_population_keeps_its_first_gears_when_it_grows() -> None:
    gear = small_plan().gears[0]
    few, many = Population(3).draw(gear, 1), Population(5).draw(gear, 1)
    assert many[:3] == few
    assert len({g.transmission.b1 for g in many}) == 5
    assert {g.number for g in many} == {1, 2, 3, 4, 5}


def test_drawn_variants_and_scatter_vary_the_healthy_recordings() -> None:
    plan = small_plan()
    variants = replace(plan.grid.variants, drawn=True)
    plan = replace(plan, grid=replace(plan.grid, variants=variants, scatter=0.005))
    recordings = record(plan, plan.cases((0, 0)))
    healthy = recordings.where(recordings.table["label"] == "healthy")
    assert healthy.table["efficiency"].is_unique
    located = recordings.table.dropna(subset="position")
    assert located.groupby("label", observed=True)["position"].nunique().eq(2).all()


def test_gears_need_numbers_of_their_own() -> None:
    plan = small_plan()
    with pytest.raises(ValueError, match=r"gear numbers \[1, 1\] are not distinct"):
        replace(plan, gears=(plan.gears[0], plan.gears[0]))
    with pytest.raises(ValueError, match="no gears"):
        replace(plan, gears=())
