"""The bench condition: every magnitude has its declared effect; a bench without magnitudes changes nothing."""

from dataclasses import fields, replace

import numpy as np
import pytest
from chain_fixtures import small_plan

from swgsim.bench.scatter import LIMITS, Bench
from swgsim.dataset.simulate_cases import record
from swgsim.gear.acquisition import Window
from swgsim.storage.labelled_signals import LabelledSignals

# The whole chain runs for every magnitude; other tests check its types.
pytestmark = pytest.mark.end_to_end

MAGNITUDES = [f.name for f in fields(Bench) if f.name != "reference_temperature"]
SILENT = Bench(**dict.fromkeys(MAGNITUDES, 0.0), reference_temperature=25.0)
PLAN = small_plan()
HEALTHY = [case for case in PLAN.grid.cases(PLAN.gears[0]) if case.variant.label == "healthy"]


def recorded(bench: Bench | None) -> LabelledSignals:
    return record(replace(PLAN, bench=bench), HEALTHY)


@pytest.fixture(scope="module")
def clean() -> LabelledSignals:
    return recorded(None)


def test_a_silent_bench_records_the_signals_of_the_chain(clean: LabelledSignals) -> None:
    silent = recorded(SILENT)
    np.testing.assert_allclose(silent.signals, clean.signals, atol=1e-7)
    np.testing.assert_allclose(silent.table["efficiency"], clean.table["efficiency"], rtol=1e-9)
    np.testing.assert_allclose(silent.table["temperature_c"], 25.0)


# (magnitude, value, smallest and largest change of the signals [mV/V], or of the efficiency).
SIGNALS = [
    ("eccentricity", 10e-6, 1e-4, 2e-2),
    ("cam_form", 2e-6, 1e-5, 1e-2),
    ("gauge_position", 0.01, 1e-4, 2e-2),
    ("load", 0.01, 1e-4, 1e-2),
    ("speed", 0.005, 1e-4, 3e-1),
    ("index_angle", 0.01, 1e-4, 3e-2),
    ("noise", 0.001, 2e-3, 1e-2),
    ("zero_drift", 0.001, 3e-4, 5e-3),
]
EFFICIENCY = [
    ("load", 0.01, 1e-4, 2e-2),
    ("output_angle", 6.28, 1e-5, 2e-2),
    ("temperature", 4.0, 1e-3, 1e-1),
    ("flange_in", 0.002, 1e-4, 3e-2),
    ("flange_out", 0.1, 1e-4, 1e-2),
    ("flange_in_bias", 0.002, 1e-5, 3e-2),
    ("flange_out_bias", 0.1, 1e-5, 1e-2),
    ("speed_reading", 1e-3, 1e-4, 5e-3),
]


def bench_with(name: str, value: float) -> Bench:
    """A bench with one magnitude, and the grease's exponent, which scales the temperature."""
    return replace(SILENT, grease_exponent=0.025, **{name: value})


@pytest.mark.parametrize(("name", "value", "low", "high"), SIGNALS)
def test_one_magnitude_changes_the_signals(
    name: str, value: float, low: float, high: float, clean: LabelledSignals
) -> None:
    change = np.abs(recorded(bench_with(name, value)).signals - clean.signals).max()
    assert low < change < high


@pytest.mark.parametrize(("name", "value", "low", "high"), EFFICIENCY)
def test_one_magnitude_changes_the_efficiency(
    name: str, value: float, low: float, high: float, clean: LabelledSignals
) -> None:
    change = np.abs(recorded(bench_with(name, value)).table["efficiency"] - clean.table["efficiency"]).max()
    assert low < change < high


def test_the_temperature_is_shown_with_its_error() -> None:
    true, shown = (recorded(b).table["temperature_c"] for b in (
        bench_with("temperature", 4.0), replace(bench_with("temperature", 4.0), temperature_error=1.0)
    ))  # fmt: skip
    assert 0.1 < np.std(shown - true) < 3
    assert np.std(true) > 1


def test_a_unit_keeps_its_imperfections_and_a_session_its_bias() -> None:
    for name, value in (("eccentricity", 10e-6), ("gauge_position", 0.01)):
        signals = recorded(bench_with(name, value)).signals
        same_point = [i for i, case in enumerate(HEALTHY) if case.run.point == HEALTHY[0].run.point]
        assert np.ptp(signals[same_point], axis=0).max() < 1e-7
    table = recorded(bench_with("flange_in_bias", 0.002)).table
    by_session = table.groupby(["reference", "n_in_rpm"])["efficiency"]
    assert (by_session.nunique() == 1).all()
    assert by_session.first().round(9).nunique() == len(by_session.first())


def test_noise_and_quantisation_of_the_window() -> None:
    noisy = record(replace(PLAN, window=Window(noise=1e-3)), HEALTHY[:2]).signals
    ideal = record(PLAN, HEALTHY[:2]).signals
    assert np.std(noisy - ideal) == pytest.approx(1e-3, rel=0.05)
    coarse = record(replace(PLAN, window=Window(quantum=1e-2)), HEALTHY[:2]).signals
    np.testing.assert_allclose(coarse / 1e-2, np.round(coarse / 1e-2), atol=1e-4)
    assert np.abs(coarse - ideal).max() <= 0.5e-2 + 1e-6


@pytest.mark.parametrize("name", list(LIMITS))
def test_the_limit_of_every_magnitude_is_named(name: str) -> None:
    high = LIMITS[name][1]
    with pytest.raises(ValueError, match=f"{name} of the bench is .*, must be a finite number from .* to {high:g}"):
        Bench(**{name: high * 1.01})
