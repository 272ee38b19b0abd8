"""Data sets: reproducible, resumable after a kill, independent of the number of workers."""

import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chain_fixtures import small_plan

from swgsim.bench.disturbance import Disturbance
from swgsim.bench.scatter import Bench
from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker
from swgsim.dataset import dataset
from swgsim.dataset import plan as plans
from swgsim.dataset.dataset import disturb, generate
from swgsim.dataset.grid import Case
from swgsim.dataset.plan import Plan, block_size
from swgsim.dataset.simulate_cases import record
from swgsim.gear.acquisition import Window
from swgsim.gear.population import Population
from swgsim.storage import storage
from swgsim.storage.labelled_signals import LabelledSignals

pytestmark = pytest.mark.end_to_end


def nothing(_: int) -> None:
    """No progress bar."""


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small plan's data set, made in small blocks and never interrupted."""
    path = tmp_path_factory.mktemp("data") / "clean.h5"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plans, "BLOCK", 10)
        generate(small_plan(), path, Engine(1), nothing)
    return path


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six blocks in the small plan: 10, 10 and 8 recordings of each gear."""
    monkeypatch.setattr(plans, "BLOCK", 10)


@pytest.fixture
def made(clean: Path, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Seeds of the recordings that this process makes; those of the small plan are remembered, not simulated."""
    known = storage.read(clean)
    seeds: list[int] = []

    def remembered(plan: Plan, cases: list[Case]) -> LabelledSignals:
        seeds.extend(case.seed for case in cases)
        if plan != small_plan():
            return record(plan, cases)
        return replace(known.where(known.table["seed"].isin(seeds[-len(cases) :])), attributes=plan.attributes)

    monkeypatch.setattr(dataset, "record", remembered)
    return seeds


def kill(program: str, path: Path, lines: int) -> None:
    """Run a program that makes a data set from the small plan; kill it with -9 when it has printed so many lines."""
    head = (
        "import sys, time; sys.path[:0] = ['tests']\n"
        "from pathlib import Path\n"
        "from chain_fixtures import small_plan\n"
        "from swgsim.common import compute\n"
        "from swgsim.dataset import dataset, plan\n"
        "from swgsim.storage import storage\n"
        "plan.BLOCK = 10\n"
    )
    command = [sys.executable, "-c", head + program, str(path)]
    with subprocess.Popen(command, cwd=Path(__file__).parents[2], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for _ in range(lines):
            assert process.stdout.readline()
        process.send_signal(signal.SIGKILL)


def stop(plan: Plan, path: Path, blocks: int) -> list[Path]:
    """Begin to make a data set; stop when so many blocks are there. Their files."""

    def progress(_: int) -> None:
        if len(list(parts.glob("*.h5"))) == blocks:
            raise KeyboardInterrupt

    parts = path.with_name(f".{path.name}.parts")
    with pytest.raises(KeyboardInterrupt):
        generate(plan, path, Engine(1), progress)
    return sorted(parts.glob("*.h5"))


def test_grid_is_complete(clean: Path) -> None:
    table = storage.read(clean).table
    samples = table[~table["reference"]]
    assert len(table) == len(small_plan()) == 2 * 2 * (2 + 6 * 2)
    assert (samples.groupby(["gear", "label", "n_in_rpm"], observed=True).size() == 2).all()
    assert (table[table["reference"]]["label"] == "healthy").all()
    assert table["seed"].is_unique


@pytest.mark.parametrize(("samples", "recordings"), [(2, 1140), (600, 1140), (3600, 190), (10_000_000, 1)])
def test_blocks_of_long_windows_hold_fewer_recordings(samples: int, recordings: int) -> None:
    assert block_size(samples) == recordings


def test_blocks_hold_the_whole_plan_gear_by_gear(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plans, "BLOCK", 10)
    plan = small_plan()
    blocks = list(plan.blocks())
    assert [len(block) for block in blocks] == [10, 10, 8, 10, 10, 8]
    assert len(blocks) == plan.block_count
    assert [case for block in blocks for case in block] == [
        case for gear in plan.gears for case in plan.grid.cases(gear)
    ]


@pytest.mark.slow
@pytest.mark.usefixtures("small_blocks")
def test_same_bytes_with_two_workers(clean: Path, tmp_path: Path) -> None:
    again = tmp_path / "clean.h5"
    generate(small_plan(), again, Engine(2), nothing)
    assert again.read_bytes() == clean.read_bytes()


BETWEEN_BLOCKS = """
report = lambda n: (print(n, flush=True), time.sleep(0.5))
dataset.generate(small_plan(), Path(sys.argv[1]), compute.Engine(1), report)
"""
WHILE_JOINING = """
read = storage.read
storage.read = lambda part: (print("joins", part, flush=True), time.sleep(0.5), read(part))[-1]
dataset.generate(small_plan(), Path(sys.argv[1]), compute.Engine(1), lambda n: None)
"""


@pytest.mark.slow
@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize(("program", "joining"), [(BETWEEN_BLOCKS, False), (WHILE_JOINING, True)])
def test_a_killed_run_resumes(program: str, joining: bool, clean: Path, tmp_path: Path, made: list[int]) -> None:
    path = tmp_path / "killed.h5"
    kill(program, path, lines=3)
    assert not path.exists()
    if joining:
        assert {p.name for p in tmp_path.iterdir()} == {".killed.h5.parts", ".killed.h5.tmp"}
    kept = {seed for part in tmp_path.glob(".killed.h5.parts/*.h5") for seed in storage.read(part).table["seed"]}
    assert joining or len(kept) >= 10 + 10 + 8
    generate(small_plan(), path, Engine(1), nothing)
    assert kept.isdisjoint(made)
    assert len(kept) + len(made) == len(small_plan())
    assert path.read_bytes() == clean.read_bytes()
    assert list(tmp_path.iterdir()) == [path]


def flipped(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


# Content of a damaged part from its own content and that of another block.
DAMAGES: dict[str, Callable[[bytes, bytes], bytes]] = {
    "truncated": lambda own, _: own[:-1],
    "emptied": lambda *_: b"",
    "flipped": lambda own, _: flipped(own),
    "copied from another block": lambda _, other: other,
}


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=list(DAMAGES))
def test_a_bad_part_is_named_and_made_again(
    damage: Callable[[bytes, bytes], bytes],
    clean: Path,
    tmp_path: Path,
    made: list[int],
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "a.h5"
    parts = stop(small_plan(), path, 3)
    parts[1].write_bytes(damage(parts[1].read_bytes(), parts[2].read_bytes()))
    made.clear()
    generate(small_plan(), path, Engine(1), nothing)
    answer = capsys.readouterr().out.splitlines()
    assert len(answer) == 1
    assert answer[0].startswith(f"{parts[1]}: ")
    assert answer[0].endswith("made again")
    assert len(made) == len(small_plan()) - (10 + 8)
    assert path.read_bytes() == clean.read_bytes()


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize(
    "changes",
    [{"window": Window(noise=1e-3), "configuration": "small test plan with noise"}, {"window": Window(samples=700)}],
)
def test_parts_of_other_choices_are_not_mixed_in(
    changes: dict, clean: Path, tmp_path: Path, made: list[int], capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.h5"
    others = stop(small_plan(**changes), path, 2)
    made.clear()
    generate(small_plan(), path, Engine(1), nothing)
    assert len(made) == len(small_plan())
    assert capsys.readouterr().out.count("made again") == len(others)
    assert path.read_bytes() == clean.read_bytes()
    assert list(tmp_path.iterdir()) == [path]


def test_nothing_is_left_of_a_plan_that_fails(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="must be even"):
        generate(small_plan(sectors=33), tmp_path / "a.h5", Engine(1), nothing)
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("made")
def test_a_part_that_a_worker_of_a_killed_run_is_at_is_not_written_at_once(tmp_path: Path) -> None:
    plan, file = small_plan(), tmp_path / "000000.h5"
    successor = threading.Thread(target=dataset._part, args=(plan, next(plan.blocks())[:2], file))
    with sole_maker(file):
        successor.start()
        successor.join(0.5)
        assert successor.is_alive()
        assert not file.exists()
    successor.join()
    assert len(storage.read(file)) == 2


@pytest.mark.usefixtures("small_blocks", "made")
def test_a_part_that_a_worker_of_a_killed_run_of_other_choices_replaced_is_not_joined(
    clean: Path, tmp_path: Path
) -> None:
    path = tmp_path / "a.h5"
    part = tmp_path / ".a.h5.parts" / "000000.h5"

    def replaced(_: int) -> None:
        if not part.with_name("000001.h5").exists():
            storage.write(part, [replace(storage.read(part), attributes=other.attributes)], 10)

    other = small_plan(configuration="other choices")
    with pytest.raises(ValueError, match=r"000000\.h5: made by other choices or code"):
        generate(small_plan(), path, Engine(1), replaced)
    assert not path.exists()
    generate(small_plan(), path, Engine(1), nothing)
    assert path.read_bytes() == clean.read_bytes()


def test_a_file_that_is_missed_meanwhile_is_named_and_not_the_folder(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"directory: 'lost'"), replacing(tmp_path / "a.h5"):
        Path("lost").read_bytes()


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
    cases = [c for c in next(plan.blocks()) if c.variant.label == "healthy"][:8]
    clean, bench = record(plan, cases), record(replace(plan, bench=Bench()), cases)
    assert len(np.unique(clean.signals[:, 1, 0])) == 2  # one value for each operating point
    assert len(np.unique(bench.signals[:, 1, 0])) == len(cases)
    assert np.isfinite(bench.table["temperature_c"]).all()
    assert clean.table["temperature_c"].isna().all()
    relative = bench.table["efficiency"] / clean.table["efficiency"] - 1
    assert 0 < relative.abs().max() < 0.3


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
    recordings = record(plan, next(plan.blocks()))
    healthy = recordings.where(recordings.table["label"] == "healthy")
    assert healthy.table["efficiency"].is_unique
    located = recordings.table.dropna(subset="position")
    assert located.groupby("label", observed=True)["position"].nunique().eq(2).all()


def test_a_further_day_repeats_every_specimen_with_other_biases() -> None:
    quiet = ("load", "speed", "temperature", "output_angle", "flange_in", "flange_out", "speed_reading")
    once = replace(small_plan(), bench=Bench(**dict.fromkeys(quiet, 0.0)))
    twice = replace(once, grid=replace(once.grid, days=2))
    first, both = (record(plan, list(plan.grid.cases(plan.gears[0]))) for plan in (once, twice))
    assert (len(first), len(both)) == (once.grid.count(), twice.grid.count())
    table = both.samples.table
    day = np.arange(len(table)) // len(once.grid.points) % 2
    pd.testing.assert_frame_equal(table[day == 0].reset_index(drop=True), first.samples.table)
    before, after = (table.loc[day == each, "efficiency"].to_numpy().reshape(-1, 2) for each in (0, 1))
    change = np.log(after / before)
    # The biases are the same for all specimens of a day.
    assert (np.abs(change.mean(axis=0)) > 10 * change.std(axis=0)).all()


def test_gears_need_numbers_of_their_own() -> None:
    plan = small_plan()
    with pytest.raises(ValueError, match=r"gear numbers \[1, 1\] are not distinct"):
        replace(plan, gears=(plan.gears[0], plan.gears[0]))
    with pytest.raises(ValueError, match="no gears"):
        replace(plan, gears=())
