"""Time and accuracy of the chain and its integrator against direct methods, as ratios measured in one run."""

import time
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from threadpoolctl import threadpool_limits

from swgsim.chain.chain import simulate
from swgsim.chain.direct import DirectSolver
from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, Drive
from swgsim.chain.harmonic_balance import one_revolution
from swgsim.chain.motion import revolve, run
from swgsim.chain.settling import steady_state
from swgsim.dataset.plan import Plan
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint, Transmission
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance

# Instants of each recording that the direct method solves; its time is scaled to all samples.
INSTANTS = 40


def chain_vs_solve_per_step(plan: Plan) -> dict[str, Any]:
    """The chain on one gear's grid against one sparse solve per sample on the same truss, factorised once.

    Returns
    -------
    dict
        ratio of the times per recording; max_relative_difference, the largest difference of a signal over its own
        largest value; max_difference_of_ripple, the same over half its range (s0 is nearly flat); both over one run of
        every class at its first severity and at its last.
    """
    gear = plan.gears[0]
    runs = [case.run for case in plan.grid.cases(gear)]
    with threadpool_limits(1):
        start = time.perf_counter()
        simulation = simulate(runs, plan.window, plan.sectors)
        chain = (time.perf_counter() - start) / len(runs)

        flex = solve_flex_spline(gear.flex_spline, gear.transmission.alpha_tooth, plan.sectors)
        instants = np.linspace(0, plan.window.samples - 1, INSTANTS).astype(int)
        seconds, relative, of_ripple = [], [], []
        for i in _extremes(plan):
            solver = DirectSolver(flex, runs[i].affected_gear, runs[i].effects)
            motion, row = simulation.motion, simulation.of_run[i]
            start = time.perf_counter()
            direct = solver.signals(motion.phi_in[row, instants], motion.T_out[row, instants])
            seconds.append(time.perf_counter() - start)
            fast = simulation.signals[i][:, instants]
            difference = np.abs(fast - direct).max(axis=1)
            relative.append((difference / np.abs(simulation.signals[i]).max(axis=1)).max())
            of_ripple.append((difference / (0.5 * np.ptp(simulation.signals[i], axis=1))).max())
    solve = np.median(seconds) / INSTANTS * plan.window.samples
    return {
        "ratio": float(solve / chain),
        "max_relative_difference": float(max(relative)),
        "max_difference_of_ripple": float(max(of_ripple)),
        "seconds_per_recording": {"chain": chain, "solve_per_step": float(solve)},
        "recordings": len(runs),
    }


def _extremes(plan: Plan) -> Sequence[int]:
    """Numbers of the first and the last case of every class at the last operating point."""
    cases = list(plan.grid.cases(plan.gears[0]))
    last = plan.grid.points[-1]
    chosen = []
    for label in plan.grid.classes:
        numbers = [i for i, c in enumerate(cases) if c.variant.label == label and c.run.point == last]
        chosen += [numbers[0], numbers[-1]]
    return chosen


def integrator_vs_solve_ivp(transmissions: Sequence[Transmission], points: Sequence[OperatingPoint]) -> dict[str, Any]:
    """The batched Runge-Kutta integrator against scipy's solve_ivp (DOP853, rtol 1e-10) run by run.

    Returns
    -------
    dict
        ratio of the times per run over the same window from the same state; max_relative_error, the largest error of
        T_out and of the speeds over their own ripple.
    """
    window = Window()
    drive = _every(transmissions, points)
    with threadpool_limits(1):
        state = steady_state(drive)
        start = time.perf_counter()
        motion = run(drive, state, 1 / window.rate, window.samples)
        batched = (time.perf_counter() - start) / len(drive)
        seconds, errors = [], []
        for i in range(len(points)):
            single = Drive([drive.transmissions[i]], [drive.points[i]])

            def rate(_: float, y: np.ndarray, single: Drive = single) -> np.ndarray:
                column = y[:, None]
                return single.derivative(column, single.torques(column))[:, 0]

            end = np.append(window.time, window.samples / window.rate)
            start = time.perf_counter()
            exact = solve_ivp(rate, (0, end[-1]), state[:, i], "DOP853", end, rtol=1e-10, atol=1e-12).y
            seconds.append(time.perf_counter() - start)
            T_out = np.array([single.torques(column[:, None]).T_out[0] for column in exact.T])
            both = ((motion.T_out, T_out), (motion.omega_in, exact[OMEGA_IN]), (motion.omega_out, exact[OMEGA_OUT]))
            errors += [np.abs(ours[i] - theirs).max() / np.ptp(theirs) for ours, theirs in both]
    return {
        "ratio": float(np.mean(seconds) / batched),
        "max_relative_error": float(max(errors)),
        "seconds_per_run": {"batched": batched, "solve_ivp": float(np.mean(seconds))},
        "runs": len(drive),
    }


def harmonic_balance_vs_integrating(
    transmissions: Sequence[Transmission], points: Sequence[OperatingPoint], samples: int = 64
) -> dict[str, Any]:
    """One revolution of the periodic motion by harmonic balance against integrating until it settles, then over it.

    Returns
    -------
    dict
        ratio of the times; max_relative_difference, the largest of T_out and of the speeds over their own mean.
    """
    drive = _every(transmissions, points)
    with threadpool_limits(1):
        start = time.perf_counter()
        balanced, _ = one_revolution(drive, np.zeros(len(drive)), samples)
        middle = time.perf_counter()
        integrated = revolve(drive, steady_state(drive), samples)
        end = time.perf_counter()
    channels = ("T_out", "omega_in", "omega_out")
    both = [(getattr(balanced, name), getattr(integrated, name)) for name in channels]
    return {
        "ratio": (end - middle) / (middle - start),
        "max_relative_difference": max(float(np.abs(a - b).max() / b.mean()) for a, b in both),
        "seconds": {"harmonic_balance": middle - start, "integrating": end - middle},
        "runs": len(drive),
    }


def errors_by_recording_vs_dense(
    recordings: int = 18, features: int = 200, kinds: int = 15, common: int = 480
) -> dict[str, Any]:
    """A covariance with errors of single recordings stored by recording, against one with all of them as dense columns.

    Returns
    -------
    dict
        ratio of the times to set up and to weigh a residual; ratio_of_bytes; max_relative_difference of the result.
    """
    rng = np.random.default_rng(0)
    noise, C = np.ones((recordings, features)), rng.standard_normal((recordings, features, kinds))
    G, r = rng.standard_normal((recordings * features, common)), rng.standard_normal(recordings * features)
    with threadpool_limits(1):
        start = time.perf_counter()
        alone = RecordingCovariance(noise, C)
        by_recording = Covariance(alone, G).weigh(r)
        middle = time.perf_counter()
        columns = np.hstack([alone.dense, G])
        dense = Covariance(RecordingCovariance.white(noise), columns).weigh(r)
        end = time.perf_counter()
    return {
        "ratio": (end - middle) / (middle - start),
        "ratio_of_bytes": columns.nbytes / (C.nbytes + G.nbytes),
        "max_relative_difference": float(np.abs(by_recording - dense).max() / np.abs(dense).max()),
        "seconds": {"by_recording": middle - start, "dense": end - middle},
    }


def further_errors_vs_anew(
    recordings: int = 18, features: int = 200, kinds: int = 15, common: int = 560, more: int = 50
) -> dict[str, Any]:
    """A covariance that is extended by errors, as when a model gains an effect, against one that is set up again.

    Returns
    -------
    dict
        ratio of the times to weigh a residual; max_relative_difference of the result.
    """
    rng = np.random.default_rng(0)
    alone = RecordingCovariance(np.ones((recordings, features)), rng.standard_normal((recordings, features, kinds)))
    G, r = rng.standard_normal((recordings * features, common + more)), rng.standard_normal(recordings * features)
    with threadpool_limits(1):
        known = Covariance(alone, G[:, :common])
        known.weigh(r)
        start = time.perf_counter()
        further = known.with_columns(G[:, common:]).weigh(r)
        middle = time.perf_counter()
        anew = Covariance(alone, G).weigh(r)
        end = time.perf_counter()
    return {
        "ratio": (end - middle) / (middle - start),
        "max_relative_difference": float(np.abs(further - anew).max() / np.abs(anew).max()),
        "seconds": {"further": middle - start, "anew": end - middle},
    }


def _every(transmissions: Sequence[Transmission], points: Sequence[OperatingPoint]) -> Drive:
    """Every gear at every operating point."""
    return Drive(*zip(*product(transmissions, points), strict=True))
