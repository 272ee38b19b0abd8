"""The oracle: its densities against SciPy's, its confidence against its accuracy, its file against its own plan."""

import shutil
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from chain_fixtures import GEAR, SEVERITIES, small_plan
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from scipy.special import logsumexp
from scipy.stats import chi2, multivariate_normal

from swgsim.bench.scatter import Bench
from swgsim.dataset.faults import Variants
from swgsim.dataset.grid import Grid
from swgsim.dataset.plan import Plan
from swgsim.dataset.simulate_cases import record
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.jobs import generate_data_set as generation
from swgsim.oracle import by_gear
from swgsim.oracle import oracle_study as oracle_job
from swgsim.oracle.cells import Cells, Partition, Resolution
from swgsim.oracle.model import Expectation, expectations, observations
from swgsim.oracle.oracle import judge, known_gear_model
from swgsim.oracle.point import PointModel
from swgsim.storage import storage
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals

pytestmark = pytest.mark.end_to_end
CONF = str(Path(__file__).parents[2] / "conf")
POINT = OperatingPoint(4000, 39)
SECTORS = 40
RESOLUTION = Resolution(
    draws=80,
    severities=dict.fromkeys(SEVERITIES, 8),
    positions={"eccentric_wave_generator": 12, "tip_tooth_crack": 15},
)
# Small faults, so that the oracle errs now and then.
SMALL = SEVERITIES | {
    "reduced_damping": (0.9, 0.99),
    "reduced_stiffness": (0.9, 0.99),
    "tip_tooth_crack": (0.05, 1.0),
}


def plan_of(variants: int, classes: tuple[str, ...] = CLASSES, bench: Bench | None = None) -> Plan:
    """One gear at one operating point, with drawn faults."""
    grid = Grid((POINT,), Variants(variants, 1, SMALL, drawn=True), classes, references=1, scatter=0.005, seed=5)
    return small_plan(gears=(GEAR,), grid=grid, bench=bench or Bench(), sectors=SECTORS, window=Window(samples=160))


PLAN = plan_of(40)


def samples_of(plan: Plan) -> LabelledSignals:
    return record(plan, list(plan.grid.cases(plan.gears[0]))).samples


@cache
def samples() -> LabelledSignals:
    return samples_of(PLAN)


@cache
def expected(gear: Gear = GEAR) -> list[Expectation]:
    return expectations(PLAN, gear, RESOLUTION)


def truth() -> np.ndarray:
    return samples().table["label"].cat.codes.to_numpy()


def test_mixture_equals_dense_gaussians() -> None:
    rng = np.random.default_rng(0)
    root = rng.normal(size=(7, 7))
    mean, covariance = rng.normal(size=7), root @ root.T + np.eye(7)
    cells = Cells(rng.normal(size=(3, 7)), 2 * rng.normal(size=(3, 2, 7)))
    x = 2 * rng.normal(size=(5, 7))
    found = PointModel(mean, covariance, {"root_tooth_crack": cells}).log_likelihood(x)
    dense = [
        multivariate_normal(mean + shift, covariance + spread.T @ spread).logpdf(x)
        for shift, spread in zip(cells.shift, cells.spread, strict=True)
    ]
    np.testing.assert_allclose(found[:, 0], multivariate_normal(mean, covariance).logpdf(x), rtol=1e-10)
    np.testing.assert_allclose(
        found[:, CLASSES.index("root_tooth_crack")], logsumexp(dense, axis=0) - np.log(3), rtol=1e-10
    )
    assert np.isneginf(found[:, CLASSES.index("tip_tooth_crack")]).all()


def test_cells_follow_a_quadratic_in_severity_and_close_around_the_flex_spline() -> None:
    resolution = replace(RESOLUTION, positions={"eccentric_wave_generator": 90, "tip_tooth_crack": 3})
    partition = Partition.of("eccentric_wave_generator", (2e-5, 5e-5, 1e-4), resolution, SECTORS)
    change = np.array([[(1e4 * v.severity) ** 2 * np.cos(v.position)] for v in partition.variants()])
    cells = partition.cells(change)
    severity = 2e-5 + 8e-5 * (np.arange(8) + 0.5) / 8
    position = 2 * np.pi * (np.arange(90) + 0.5) / 90
    shift = (1e4 * severity[:, None]) ** 2 * np.cos(position)
    np.testing.assert_allclose(cells.shift, shift.reshape(-1, 1), atol=1e-12)
    # A standard deviation is the slope times the side of the cell over the root of 12.
    along_severity = 2e8 * severity[:, None] * np.cos(position) * 1e-5 / np.sqrt(12)
    along_position = -((1e4 * severity[:, None]) ** 2) * np.sin(position) * 2 * np.pi / 90 / np.sqrt(12)
    np.testing.assert_allclose(cells.spread[:, 0, 0], along_severity.ravel(), atol=1e-12)
    np.testing.assert_allclose(cells.spread[:, 1, 0], along_position.ravel(), atol=1e-4)


def test_root_cracks_have_one_cell_for_each_gap_and_no_spread_within() -> None:
    partition = Partition.of("root_tooth_crack", (0.1, 0.01), RESOLUTION, SECTORS)
    gaps = {int(variant.position * SECTORS / (2 * np.pi)) for variant in partition.variants()}
    assert gaps == set(range(SECTORS))
    # A hinge's opening, whose interpolation over three severities is good to a few per cent.
    opening = np.array([[1 / (0.05 + v.severity)] for v in partition.variants()])
    cells = partition.cells(opening)
    assert cells.spread.shape == (8 * SECTORS, 1, 1)
    severity = 0.01 + 0.09 * (np.arange(8) + 0.5) / 8
    np.testing.assert_allclose(cells.shift[::SECTORS, 0], 1 / (0.05 + severity), rtol=2e-2)


def test_a_class_of_one_severity_has_no_spread_along_it() -> None:
    partition = Partition.of("reduced_damping", (0.8,), RESOLUTION, SECTORS)
    assert [variant.severity for variant in partition.variants()] == [0.8]
    np.testing.assert_array_equal(partition.cells(np.ones((1, 4))).spread, 0)


def test_healthy_recordings_spread_as_the_model_says() -> None:
    """In white units the mean square of a healthy recording is 1, of the efficiency and every gauge as well."""
    model = known_gear_model(PLAN, GEAR, expected()[:1], session_known=True)
    healthy = observations(samples().where(truth() == 0)) - model.mean
    white = np.linalg.solve(np.linalg.cholesky(model.covariance), healthy.T)
    assert (white**2).mean() == pytest.approx(1, abs=4 * np.sqrt(2 / white.size))
    single = (healthy**2).mean(axis=0) / np.diag(model.covariance)
    low, high = chi2.ppf([1e-5, 1 - 1e-5], len(healthy)) / len(healthy)
    assert low < single.min()
    assert single.max() < high


@pytest.mark.parametrize("session_known", [True, False])
def test_operating_points_together_have_the_distributions_of_each(session_known: bool) -> None:
    points = [expected()[0]] * 2  # the same point twice is a unit of two recordings
    together = known_gear_model(PLAN, GEAR, points, session_known)
    alone = [known_gear_model(PLAN, GEAR, [each], session_known) for each in points]
    np.testing.assert_allclose(together.mean, np.concatenate([each.mean for each in alone]))
    size = len(alone[0].mean)
    for number, each in enumerate(alone):
        here = slice(number * size, (number + 1) * size)
        np.testing.assert_allclose(together.covariance[here, here], each.covariance)
    # Only biases that are not known are the same at all of them.
    assert (np.abs(together.covariance[:size, size:]).max() > 0) != session_known


def test_confidence_equals_accuracy_and_the_wrong_gear_does_worse() -> None:
    p = judge(PLAN, GEAR, expected(), samples(), session_known=True)
    np.testing.assert_allclose(p.sum(axis=1), 1, rtol=1e-12)
    right, confidence = p.argmax(axis=1) == truth(), p.max(axis=1)
    assert 0.6 < right.mean() < 0.97
    deviation = np.sqrt((confidence * (1 - confidence)).sum())
    assert abs(right.sum() - confidence.sum()) < 3 * deviation
    wrong = replace(GEAR, transmission=replace(GEAR.transmission, b1=0.9 * GEAR.transmission.b1))
    q = judge(PLAN, GEAR, expected(wrong), samples(), session_known=True)
    assert (q.argmax(axis=1) == truth()).mean() < right.mean() - 0.05
    rows = np.arange(len(p)), truth()
    assert np.log(q[rows]).mean() < np.log(p[rows]).mean() - 0.1


def test_a_large_eccentricity_is_certain() -> None:
    p = judge(PLAN, GEAR, expected(), samples(), session_known=False)
    large = (samples().table["label"] == "eccentric_wave_generator") & (samples().table["severity"] > 6e-5)
    assert large.sum() > 10
    assert p[large, CLASSES.index("eccentric_wave_generator")].min() > 0.999


def test_a_known_session_explains_the_efficiency() -> None:
    plan = plan_of(20, ("healthy", "reduced_damping"), Bench(flange_out_bias=1.0, flange_in_bias=0.0))
    made = samples_of(plan)
    at_point = expectations(plan, GEAR, RESOLUTION)[0]
    known, unknown = (known_gear_model(plan, GEAR, [at_point], session_known) for session_known in (True, False))
    healthy = made.where(made.table["label"] == "healthy")
    seen = observations(healthy)[:, -2].mean()
    assert abs(seen - known.mean[-2]) < 0.25 * abs(seen - unknown.mean[-2])
    assert known.covariance[-2, -2] < unknown.covariance[-2, -2]
    knowing, guessing = (judge(plan, GEAR, [at_point], made, session_known) for session_known in (True, False))
    rows = np.arange(len(made)), made.table["label"].cat.codes.to_numpy()
    assert np.log(knowing[rows]).mean() > np.log(guessing[rows]).mean() + 0.05
    assert (knowing[:, 2:] == 0).all()


def refused_plans() -> list[tuple[Plan, str]]:
    listed = replace(PLAN.grid, variants=Variants(2, 1, SEVERITIES))
    return [
        (replace(PLAN, grid=listed), r"a list \(drawn is false\).*choose a grid whose variants are drawn"),
        (replace(PLAN, bench=None), "the plan has none: choose condition=bench"),
        (plan_of(2, ("reduced_damping",)), "no 'healthy' among the classes"),
        (plan_of(2, ("healthy",), Bench(temperature_error=0.0)), "infinitely sure: give it noise"),
        (replace(PLAN, gears=(replace(GEAR, number=2),)), "recording 0 is of gear 1 at 4000 rpm and 39 N m"),
    ]


@pytest.mark.parametrize(("plan", "message"), refused_plans())
def test_plans_that_cannot_be_judged_are_refused(plan: Plan, message: str) -> None:
    (gear,), sample = plan.gears, samples().where(np.array([0]))
    with pytest.raises(ValueError, match=message):
        judge(plan, gear, expectations(plan, gear, Resolution(draws=20)), sample, session_known=False)


def test_references_are_refused() -> None:
    cases = list(PLAN.grid.cases(GEAR))[:2]
    with pytest.raises(ValueError, match=r"1 of the recordings are references.*recordings\.samples"):
        judge(PLAN, GEAR, expected(), record(PLAN, cases), session_known=False)


def composed(name: str, *overrides: str) -> dict[str, Any]:
    with initialize_config_dir(CONF, version_base="1.3"):
        return OmegaConf.to_container(compose(name, list(overrides)), resolve=True)


COARSE = (
    "workers=1",
    "resolution.draws=20",
    "resolution.nodes=2",
    "resolution.positions={eccentric_wave_generator: 3, tip_tooth_crack: 3}",
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data")
    tiny = (
        "grid.variants=2",
        "grid.population.count=2",
        "grid.references=1",
        "mesh.sectors=40",
        "window.samples=160",
        "workers=1",
    )
    point = ("grid.speeds_rpm=[4000]", "grid.loads_nm=[39]")
    generation.run(composed("generate", "grid=sampled", "condition=bench", f"data={folder}", *tiny, *point))
    return folder


@pytest.fixture
def data(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "data"))


def test_job_keeps_probabilities_in_the_order_of_the_samples(data: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = composed("oracle", f"data={data}", "gears=[1]", *COARSE)
    first = oracle_job.run(config)
    path = data / "sampled-bench-oracle.parquet"
    table = pd.read_parquet(path)
    assert list(table.columns) == ["row", *CLASSES, *("known:" + label for label in CLASSES)]
    recordings = storage.read(data / "sampled-bench.h5").samples
    recordings = recordings.where(recordings.table["gear"] == 1)
    assert list(table["row"]) == list(range(len(recordings)))
    said = table[list(CLASSES)].to_numpy()
    accuracy = (said.argmax(axis=1) == recordings.table["label"].cat.codes).mean()
    assert first["accuracy"] == pytest.approx(accuracy)
    assert {p.name for p in data.iterdir()} == {"sampled-bench.h5", "sampled-bench.json", path.name}

    capsys.readouterr()
    assert oracle_job.run(config) == first
    assert "is there already" in capsys.readouterr().out


def test_job_goes_on_from_the_gears_that_a_killed_run_left(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = composed("oracle", f"data={data}", *COARSE)
    judged = []

    def counted(plan: Plan, gear: Gear, resolution: Resolution, first: int, samples: LabelledSignals) -> pd.DataFrame:
        judged.append(gear.number)
        if judged == [1, 2]:
            raise KeyboardInterrupt
        columns = (*CLASSES, *("known:" + label for label in CLASSES))
        return pd.DataFrame({"row": np.arange(first, first + len(samples))} | dict.fromkeys(columns, 1 / 6))

    monkeypatch.setattr(oracle_job, "_judged", counted)
    with pytest.raises(KeyboardInterrupt):
        oracle_job.run(config)
    assert oracle_job.run(config)["samples"] == 24
    assert judged == [1, 2, 2]
    # Another resolution is another result.
    oracle_job.run(config | {"resolution": config["resolution"] | {"draws": 21}})
    assert judged == [1, 2, 2, 1, 2]
    # A single gear keeps the numbers of its samples.
    assert oracle_job.run(config | {"gears": [2]})["samples"] == 12
    assert list(pd.read_parquet(data / "sampled-bench-oracle.parquet")["row"]) == list(range(12, 24))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gears": [1, 9]}, r"gears is \[1, 9\], the data set has \[1, 2\]: choose some of them, or null"),
        ({"condition": {"name": "clean"}}, "make it with 'swg generate grid=sampled condition=clean'"),
    ],
)
def test_job_names_what_is_missing(change: dict[str, Any], message: str, data: Path) -> None:
    with pytest.raises(ValueError, match=message):
        oracle_job.run(composed("oracle", f"data={data}", *COARSE) | change)


def test_job_refuses_a_data_set_of_other_code(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(by_gear, "code_version", lambda *_: "another")
    with pytest.raises(ValueError, match=r"was made by code .*, while this is another.*make the data set again"):
        oracle_job.run(composed("oracle", f"data={data}", *COARSE))
