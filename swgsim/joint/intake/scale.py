"""Distance by angle against distance by velocity: rates without a clock, wrong units, missing rows."""

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.thresholds import (
    FEWEST_FOR_MEDIAN,
    LEAST_MOVED,
    NAMED_HALF,
    ONE_WAY,
    SCALE_REFUSES,
    SCALE_WARNS,
    UNIT_TOLERANCE,
    WINDOWS,
)
from swgsim.recordings.checks.defect import Defect

# Kind of finding, distance by the angle / distance by the velocity, likely reason.
MISTAKES = (
    ("angle_in_degrees", 180 / pi, "the angle is in degrees"),
    ("angle_in_revolutions", 1 / (2 * pi), "the angle is in revolutions"),
    ("velocity_in_deg_s", pi / 180, "the velocity is in degrees per second"),
    ("velocity_in_rpm", pi / 30, "the velocity is in revolutions per minute"),
    ("velocity_in_rev_s", 2 * pi, "the velocity is in revolutions per second"),
    ("time_unit", 1e-3, "the time is in milliseconds, or the velocity a thousand times too large"),
    ("time_unit", 1e3, "the time is a thousand times too small, or the velocity is"),
)
# Where no clock was recorded.
HALVES = (
    ("half_rate", 2.0, "every other row is missing, or the velocity is half of its true value"),
    ("double_rate", 0.5, "every row is written twice, or the velocity is twice its true value"),
)


class Way(NamedTuple):
    """Sums over the steps of a run, each counted in the direction of the motion.

    Attributes
    ----------
    by_angle : float
        [rad].
    by_velocity : float
        [rad] if time was given, else [rad/s].
    """

    by_angle: float
    by_velocity: float


def way(
    q: Float[np.ndarray, " time"], omega: Float[np.ndarray, " time"], time: Float[np.ndarray, " time"] | None = None
) -> Way:
    """Distance that a joint moved, by its angle and by its velocity; the two are equal if both signals are right.

    A run in one direction is taken as a whole, so that the noise of the angle cancels. In a run that reverses, each
    step counts with the local direction of rotation, because the displacement is near zero. Steps with a velocity of
    exactly 0 do not count: drives write 0 below some speed, and the angle may move there.

    Parameters
    ----------
    q, omega : array (time,)
        [rad], [rad/s].
    time : array (time,), optional
        [s]; steps of 1 without it.
    """
    steps = np.where(reads_zero(omega), 0.0, np.diff(q))
    areas = (omega[1:] + omega[:-1]) / 2 * (1.0 if time is None else np.diff(time))
    sense = np.full(len(steps), 1.0 if q[-1] >= q[0] else -1.0)
    if abs(q[-1] - q[0]) < ONE_WAY * np.ptp(q):
        half = max(len(q) // WINDOWS // 2, 1)
        ahead = np.minimum(np.arange(len(steps)) + 1 + half, len(q) - 1)
        behind = np.maximum(np.arange(len(steps)) - half, 0)
        sense = np.sign(q[ahead] - q[behind])
    return Way(float(sense @ steps), float(sense @ areas))


def reads_zero(omega: Float[np.ndarray, " time"]) -> Bool[np.ndarray, " step"]:
    """Steps at whose ends a velocity is exactly 0."""
    return (omega[1:] == 0) & (omega[:-1] == 0)


def measured_rates(runs: Sequence[Run]) -> dict[str, float]:
    """Mean velocity over mean step of the angle [Hz] by the name of each run that moved far enough.

    If a file has several joints, the joint that moved most gives the rate.
    """
    furthest: dict[str, tuple[float, float]] = {}
    for run in runs:
        by_angle, by_velocity = way(run.signals["q"], run.signals["omega"])
        if abs(by_angle) >= LEAST_MOVED and by_velocity:
            furthest[run.name] = max(furthest.get(run.name, (0.0, 0.0)), (abs(by_angle), abs(by_velocity / by_angle)))
    return {name: rate for name, (_, rate) in furthest.items()}


def usual_rates(runs: Sequence[Run], measured: Mapping[str, float], source: JointSource) -> dict[str, float]:
    """Expected rate of each run [Hz]: the declared rate, or, with ``rate: from_motion``, the median of its session,
    else of all runs, else the declared rate. Empty with a clock, or without any information.
    """
    if not source.rate_from_motion or not measured:
        return {run.name: source.rate_hz for run in runs if source.rate_hz is not None}
    everywhere = float(np.median(list(measured.values())))
    usual: dict[str, float] = {}
    for session in {run.session for run in runs}:
        names = {run.name for run in runs if run.session == session}
        rates = [rate for name, rate in measured.items() if name in names]
        usual |= dict.fromkeys(names, float(np.median(rates)) if rates else everywhere)
    return usual


def mistake(ratio: float, gear_ratio: float | None, clock: bool) -> tuple[str, str] | None:
    """Kind of finding and likely reason; None if no known mistake has this ratio.

    Parameters
    ----------
    ratio : float
        Distance by the angle over distance by the velocity, without its sign.
    gear_ratio : float or None
    clock : bool
        Whether a clock was recorded, which rules out missing rows.

    >>> mistake(57.0, None, clock=True)
    ('angle_in_degrees', 'the angle is in degrees')
    """
    for kind, factor, reason in () if clock else HALVES:
        if abs(ratio / factor - 1) < NAMED_HALF:
            return kind, reason
    if gear_ratio is not None and abs(ratio * gear_ratio - 1) < UNIT_TOLERANCE:
        return "velocity_of_motor", f"the velocity is that of the motor, {gear_ratio:g} times that of the output"
    if gear_ratio is not None and abs(ratio / gear_ratio - 1) < UNIT_TOLERANCE:
        return "angle_of_motor", f"the angle is that of the motor, {gear_ratio:g} times that of the output"
    return next(((kind, reason) for kind, factor, reason in MISTAKES if abs(ratio / factor - 1) < UNIT_TOLERANCE), None)


def clock_findings(run: Run, rate: float | None) -> Iterator[Defect]:
    """Findings of one run with known time.

    Parameters
    ----------
    run : Run
    rate : float or None
        The declared rate [Hz]; None if a clock was recorded.
    """
    moved = way(run.signals["q"], run.signals["omega"], run.time)
    if abs(moved.by_angle) < LEAST_MOVED or not moved.by_velocity:
        return
    yield from _sign(run, moved)
    basis = "by the clock" if rate is None else f"at {rate:g} Hz"
    yield from _scale(run, abs(moved.by_angle / moved.by_velocity), basis, clock=rate is None)


def rate_findings(runs: Sequence[Run], measured: Mapping[str, float], source: JointSource) -> Iterator[Defect]:
    """Findings of runs whose rate comes from their motion, against the rate of the session and the declared rate.

    Parameters
    ----------
    runs : sequence of Run
    measured : mapping
        Rates [Hz] by names of runs.
    source : JointSource
    """
    for run in runs:
        moved = way(run.signals["q"], run.signals["omega"])
        if run.name not in measured:
            if abs(moved.by_angle) < LEAST_MOVED:
                yield Defect(
                    "rate_of_others", "warn", run.label, "q", f"an angle that moves {abs(moved.by_angle):.2g} rad",
                    f"at least {LEAST_MOVED} rad",
                    "its rate is the median of the other runs; give rate_hz if it is known",
                )  # fmt: skip
            continue
        if abs(moved.by_angle) >= LEAST_MOVED:
            yield from _sign(run, moved)
        names = {each.name for each in runs if each.session == run.session}
        rates = [measured[name] for name in names if name in measured]
        references = []
        if len(rates) >= FEWEST_FOR_MEDIAN:
            references.append((float(np.median(rates)), "as in most runs of the session"))
        if source.rate_hz is not None:
            references.append((source.rate_hz, "the declared rate_hz"))
        if not references and len(measured) >= FEWEST_FOR_MEDIAN:
            references.append((float(np.median(list(measured.values()))), "as in most runs of all sessions"))
        found = [
            defect
            for reference, origin in references
            for defect in _scale(run, reference / measured[run.name], f"at {reference:.0f} Hz, {origin}")
        ]
        yield from found[:1]


def no_rate(run: Run) -> Defect:
    """Finding of a run without any information on its rate."""
    return Defect(
        "no_rate", "refuse", run.label, "", f"no run that moved by {LEAST_MOVED} rad, from which the rate would follow",
        "a rate", "give rate_hz in the source",
    )  # fmt: skip


def _sign(run: Run, moved: Way) -> Iterator[Defect]:
    if moved.by_angle * moved.by_velocity < 0:
        yield Defect(
            "velocity_backwards", "refuse", run.label, "omega", "a velocity opposite to the change of the angle",
            "the same sign for both", "set inverted: true for the velocity or the angle, whichever is wrong",
        )  # fmt: skip


def _scale(run: Run, ratio: float, basis: str, clock: bool = False) -> Iterator[Defect]:
    """Finding for a ratio of the distance by the angle to that by the velocity, unless the two agree."""
    off = abs(ratio - 1)
    if off <= SCALE_WARNS:
        return
    known = mistake(ratio, run.joint.gear_ratio, clock)
    rows = "" if clock else ", or rows are missing"
    kind, reason = known or ("velocity_scale", f"a unit is wrong{rows}; a factor of {ratio:.4g} fits")
    refuses = known is not None or off > SCALE_REFUSES
    yield Defect(
        kind, "refuse" if refuses else "warn", run.label, "omega",
        f"an angle that moves {ratio:.4g} times as far as the velocity gives {basis}", "1 time",
        f"likely {reason}; correct unit or factor in the source, or set omega: {{from: q, smoothed_s: 0.05}}",
    )  # fmt: skip
