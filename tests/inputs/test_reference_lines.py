"""Inputs of the fast twin: residual lines of rows of references, and the symmetry of the four gauges."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from twin_fixtures import PLAN, POINTS, recordings

from learn.inputs.lines import ResidualLines
from learn.inputs.reference_lines import QUARTERS, SHOWN, ReferenceLines, turned
from learn.inputs.referenced import Referenced
from swgsim.chain.chain import Run
from swgsim.dataset.faults import Variant
from swgsim.dataset.grid import Case
from swgsim.dataset.simulate_cases import record
from swgsim.effects import TipToothCrack
from swgsim.oracle.model import ORDERS
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals
from swgsim.storage.orders import lines_of

pytestmark = pytest.mark.end_to_end
INPUTS = ReferenceLines(PLAN.window, POINTS)


def rows_of(data: LabelledSignals) -> np.ndarray:
    return np.asarray(Referenced("referenced").learning_set([data]).features)


def test_inputs_begin_with_the_residual_lines_of_the_recording() -> None:
    made = INPUTS(rows_of(recordings()))
    known = ResidualLines("lines", efficiency=False, operating_point=False).learning_set([recordings()])
    names = [f"{part} s0[{order}]" for part in ("Re", "Im") for order in SHOWN]
    lines = np.asarray(known.features)[:, [known.names.index(name) for name in ("s0[0]", *names)]]
    np.testing.assert_allclose(made[:, : lines.shape[1]], lines, atol=1e-9)


def lines_of_turned(quarters: int) -> np.ndarray:
    """Lines of a cracked gear without errors of gauges; crack and kinematic error are turned."""
    angle = quarters * 2 * np.pi / QUARTERS
    errors = tuple(replace(term, phase=term.phase - term.order * angle) for term in GEAR.transmission.kinematic_error)
    gear = GEAR.with_transmission(kinematic_error=errors, b3=0.0)
    cracked = Variant("tip_tooth_crack", 0, 0.8, 0.0, (TipToothCrack(0.8, 0.3 + angle),))
    cases = [Case(Run(gear, point, cracked.effects), cracked, False, 1) for point in POINTS]
    return lines_of(record(replace(PLAN, gears=(gear,), bench=None), cases), ORDERS)


def test_a_turned_gear_is_a_gear_of_the_series() -> None:
    """Gear, crack, gauges and trigger a quarter turn further: the chain gives the lines that turning gives.

    But for the ripple of the speed, in which the trigger then comes some milliradians earlier or later.
    """
    still = lines_of_turned(0)
    size = np.abs(still).max(axis=1, keepdims=True)
    for quarters in range(1, QUARTERS):
        again = lines_of_turned(quarters)
        assert (np.abs(turned(still, quarters) - again) / size).max() < 0.02
        assert (np.abs(still - again) / size).max() > 0.5


def test_inputs_without_a_direction_stay_when_the_gear_is_turned() -> None:
    rows = rows_of(recordings())[::9]
    once, again = INPUTS(rows), INPUTS(rows, 1)
    lines = len(SENSORS) * (1 + 2 * len(SHOWN))
    same = np.isclose(once, again, rtol=1e-6, atol=1e-12).all(axis=0)
    assert not same[:lines].all()
    assert same[lines : -lines - 2 * len(POINTS)].mean() > 0.9  # all but the ripple of s0
    np.testing.assert_allclose(INPUTS(rows, QUARTERS), once)


def test_inputs_of_a_recording_without_reference_are_refused() -> None:
    rows = rows_of(recordings())[:3].copy()
    rows[1, 1] = 33.0
    with pytest.raises(ValueError, match=r"no reference at 4000 rpm and 33 N m"):
        INPUTS(rows)
