"""The oracle: class probabilities with known gear, faults and statistics of the bench.

No classifier has a lower mean error. The oracle's error is the part of a classifier's error that the task causes.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.linalg import block_diag

from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.oracle.cells import Cells
from swgsim.oracle.model import ORDERS, Expectation, bench_of, observations
from swgsim.oracle.point import PointModel
from swgsim.oracle.recording_errors import with_recording_errors
from swgsim.storage.labelled_signals import CLASSES, SENSORS, LabelledSignals
from swgsim.storage.orders import whole_revolutions

# Indices of the logarithm of the efficiency and of the temperature in an observation, and the length of one.
EFFICIENCY, TEMPERATURE = -2, -1
FEATURES = len(SENSORS) * (2 * ORDERS + 1) + 2


def added_variance(
    plan: Plan, gear: Gear, point: OperatingPoint, log_efficiency: float
) -> Float[np.ndarray, " feature"]:
    """Variance of the errors that are added to a single recording, without the session of the flanges.

    Parameters
    ----------
    plan : Plan
        With bench and window.
    gear : Gear
    point : OperatingPoint
    log_efficiency : float
        Of the healthy gear, from which the torque at the input follows.

    Raises
    ------
    ValueError
        If a part of the observation has no random error, so that the classes would be certain.
    """
    bench = bench_of(plan)
    length = whole_revolutions(point.n_in_rpm, plan.window.rate, plan.window.samples)
    white = (bench.noise**2 + plan.window.noise**2 + plan.window.quantum**2 / 12) / length
    added = np.full(FEATURES, 2 * white)
    added[np.arange(len(SENSORS)) * (ORDERS + 1)] = white + bench.zero_drift**2
    T_in, T_out = _torques(gear, point, log_efficiency)
    added[EFFICIENCY] = (bench.flange_out / T_out) ** 2 + (bench.flange_in / T_in) ** 2 + bench.speed_reading**2
    added[TEMPERATURE] = bench.temperature_error**2
    if not (added > 0).all():
        raise ValueError(
            "the bench adds nothing random to the signals, the efficiency or the temperature, and the oracle would be "
            "infinitely sure: give it noise, flange_in or flange_out, and temperature_error above 0"
        )
    return added


def session_columns(
    plan: Plan, gear: Gear, point: OperatingPoint, log_efficiency: float
) -> Float[np.ndarray, "feature 2"]:
    """What the biases of both torque flanges make of the observation, one standard deviation each."""
    bench = bench_of(plan)
    T_in, T_out = _torques(gear, point, log_efficiency)
    columns = np.zeros((FEATURES, 2))
    columns[EFFICIENCY] = -bench.flange_in_bias / T_in, bench.flange_out_bias / T_out
    return columns


def _torques(gear: Gear, point: OperatingPoint, log_efficiency: float) -> tuple[float, float]:
    """Torques at input and output [N m]."""
    return point.T_out / ((gear.transmission.N + 1) * float(np.exp(log_efficiency))), point.T_out


def known_gear_model(plan: Plan, gear: Gear, expected: Sequence[Expectation], session_known: bool) -> PointModel:
    """The distributions at one operating point or at several together, of a gear that is known.

    Parameters
    ----------
    plan : Plan
        Plan of the data set, with bench, window and seed.
    gear : Gear
    expected : sequence of Expectation
        Of this gear, one for each operating point; the observations follow each other in this order.
    session_known : bool
        Whether the oracle also knows the bias of the torque flanges during the session of the gear's samples.

    Raises
    ------
    ValueError
        As :func:`added_variance`.
    """
    levels = [float(each.healthy[:, EFFICIENCY].mean()) for each in expected]
    if not session_known:
        columns = [session_columns(plan, gear, e.point, level) for e, level in zip(expected, levels, strict=True)]
        return joint_model(plan, gear, expected, np.concatenate(columns))
    model = joint_model(plan, gear, expected, np.zeros((len(expected) * FEATURES, 0)))
    session = plan.session(gear)
    for number, (each, level) in enumerate(zip(expected, levels, strict=True), 1):
        T_in, T_out = _torques(gear, each.point, level)
        bias = np.log1p(session.T_out / T_out) - np.log1p(session.T_in / T_in)
        model.mean[number * FEATURES + EFFICIENCY] += bias
    return model


def joint_model(
    plan: Plan, gear: Gear, expected: Sequence[Expectation], shared: Float[np.ndarray, "row column"], days: int = 1
) -> PointModel:
    """The distributions of one recording, or of one recording at each of several operating points together.

    Parameters
    ----------
    plan, gear
        As in :func:`known_gear_model`.
    expected : sequence of Expectation
        One for each operating point; the observations follow each other in this order.
    shared : array (row, column)
        Errors that are the same at all these operating points, one standard deviation each.
    days : int
        Number of days whose mean is observed.

    Raises
    ------
    ValueError
        As :func:`added_variance`.
    """
    means = [each.healthy.mean(axis=0) for each in expected]
    covariances = [
        (np.cov(each.healthy, rowvar=False) + np.diag(added_variance(plan, gear, each.point, mean[EFFICIENCY]))) / days
        for each, mean in zip(expected, means, strict=True)
    ]
    faults = {
        label: Cells(
            np.concatenate([each.faults[label].shift for each in expected], axis=-1),
            np.concatenate([each.faults[label].spread for each in expected], axis=-1),
        )
        for label in expected[0].faults
    }
    if len(expected) == 1:
        # Units would need two more directions for every operating point, which is too much for the memory.
        faults = {label: with_recording_errors(cells, bench_of(plan)) for label, cells in faults.items()}
    return PointModel(np.concatenate(means), block_diag(*covariances) + shared @ shared.T, faults)


def judge(
    plan: Plan, gear: Gear, expected: Sequence[Expectation], samples: LabelledSignals, session_known: bool
) -> Float[np.ndarray, "sample class"]:
    """Posterior probability of each of CLASSES for recordings of one gear.

    Parameters
    ----------
    plan : Plan
        Plan of the data set of the samples.
    gear : Gear
    expected : sequence of Expectation
        Expectations of this gear at every operating point of its samples.
    samples : LabelledSignals
        Recordings without references.
    session_known : bool
        As in :func:`known_gear_model`.

    Raises
    ------
    ValueError
        If a recording is a reference, or of another gear or operating point, or the plan has several days.
    """
    table = samples.table
    if session_known and plan.grid.days > 1:
        raise ValueError(f"{plan.grid.days} days of every specimen, each a session, and one is known: take days=1")
    if table["reference"].any():
        raise ValueError(
            f"{table['reference'].sum()} of the recordings are references, which are of another session: leave them "
            "out with recordings.samples"
        )
    x = observations(samples)
    found = np.full((len(x), len(CLASSES)), np.nan)
    for at_point in expected:
        point = at_point.point
        here = (table["n_in_rpm"] == point.n_in_rpm) & (table["T_out_nm"] == point.T_out)
        rows = np.flatnonzero(here & (table["gear"] == gear.number))
        found[rows] = np.exp(known_gear_model(plan, gear, [at_point], session_known).log_posterior(x[rows]))
    left = np.flatnonzero(np.isnan(found).any(axis=1))
    if len(left):
        number, speed, load = table[["gear", "n_in_rpm", "T_out_nm"]].iloc[left[0]]
        raise ValueError(
            f"recording {left[0]} is of gear {number:g} at {speed:g} rpm and {load:g} N m, of which nothing is "
            "expected: judge the recordings of a data set gear by gear, by its own plan"
        )
    return found
