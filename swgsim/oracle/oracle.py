"""The oracle: class probabilities with known gear, faults and statistics of the bench.

No classifier has a lower mean error. The oracle's error is the part of a classifier's error that the task causes.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.bench.scatter import Session
from swgsim.common.seeds import generator
from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear
from swgsim.oracle.model import ORDERS, Expectation, bench_of, observations
from swgsim.oracle.point import PointModel
from swgsim.storage.labelled_signals import CLASSES, SENSORS, LabelledSignals
from swgsim.storage.orders import whole_revolutions

# Indices of the logarithm of the efficiency and of the temperature in an observation.
EFFICIENCY, TEMPERATURE = -2, -1


def point_model(plan: Plan, gear: Gear, expected: Expectation, session_known: bool) -> PointModel:
    """The distributions at one operating point: expected observations plus the errors that are added to a recording.

    Parameters
    ----------
    plan : Plan
        Plan of the data set, with bench, window and seed.
    gear : Gear
    expected : Expectation
        Expectation of this gear at the operating point.
    session_known : bool
        Whether the oracle also knows the bias of the torque flanges during the session of the gear's samples.

    Raises
    ------
    ValueError
        If a part of the observation has no random error, so that the classes would be certain.
    """
    bench, point = bench_of(plan), expected.point
    mean = expected.healthy.mean(axis=0)
    length = whole_revolutions(point.n_in_rpm, plan.window.rate, plan.window.samples)
    white = (bench.noise**2 + plan.window.noise**2 + plan.window.quantum**2 / 12) / length
    means = np.arange(len(SENSORS)) * (ORDERS + 1)
    added = np.full(len(mean), 2 * white)
    added[means] = white + bench.zero_drift**2

    T_out = point.T_out
    T_in = T_out / ((gear.transmission.N + 1) * np.exp(mean[EFFICIENCY]))
    session = Session(0.0, 0.0)
    added[EFFICIENCY] = (bench.flange_out / T_out) ** 2 + (bench.flange_in / T_in) ** 2 + bench.speed_reading**2
    if session_known:
        session = bench.session(generator("session", plan.grid.seed, gear.number, False))
    else:
        added[EFFICIENCY] += (bench.flange_out_bias / T_out) ** 2 + (bench.flange_in_bias / T_in) ** 2
    mean[EFFICIENCY] += np.log1p(session.T_out / T_out) - np.log1p(session.T_in / T_in)
    added[TEMPERATURE] = bench.temperature_error**2
    if not (added > 0).all():
        raise ValueError(
            "the bench adds nothing random to the signals, the efficiency or the temperature, and the oracle would be "
            "infinitely sure: give it noise, flange_in or flange_out, and temperature_error above 0"
        )
    return PointModel(mean, np.cov(expected.healthy, rowvar=False) + np.diag(added), expected.faults)


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
        As in :func:`point_model`.

    Raises
    ------
    ValueError
        If a recording is a reference, or of another gear or operating point.
    """
    table = samples.table
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
        found[rows] = np.exp(point_model(plan, gear, at_point, session_known).log_posterior(x[rows]))
    left = np.flatnonzero(np.isnan(found).any(axis=1))
    if len(left):
        number, speed, load = table[["gear", "n_in_rpm", "T_out_nm"]].iloc[left[0]]
        raise ValueError(
            f"recording {left[0]} is of gear {number:g} at {speed:g} rpm and {load:g} N m, of which nothing is "
            "expected: judge the recordings of a data set gear by gear, by its own plan"
        )
    return found
