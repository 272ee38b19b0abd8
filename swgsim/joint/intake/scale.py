"""Whether an angle goes as far as its velocity says, by the clock of the run or beside the other runs."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from swgsim.joint.intake.mistakes import mistake
from swgsim.joint.intake.motion import Way, way
from swgsim.joint.intake.run import Run
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.thresholds import FEWEST_FOR_MEDIAN, LEAST_MOVED, SCALE_REFUSES, SCALE_WARNS
from swgsim.recordings.checks.defect import Defect


def clock_findings(run: Run, rate: float | None) -> Iterator[Defect]:
    """Of one run whose time is known.

    Parameters
    ----------
    run : Run
    rate : float or None
        The declared one [Hz]; None if the run has a time.
    """
    time = run.time if run.time is not None else np.arange(len(run)) / (rate or 1.0)
    went = way(run.signals["q"], run.signals["omega"], time)
    if abs(went.by_angle) < LEAST_MOVED or not went.by_velocity:
        return
    yield from _sign(run, went)
    said = "its velocity says by the clock" if run.time is not None else f"its velocity says at {rate:g} Hz"
    found = _scale(run, abs(went.by_angle / went.by_velocity), said)
    if found is not None:
        yield found


def rate_findings(runs: Sequence[Run], measured: Mapping[str, float], source: JointSource) -> Iterator[Defect]:
    """Of runs whose rate comes from their motion: beside those of the session, and the declared one.

    Parameters
    ----------
    runs : sequence of Run
    measured : mapping
        Rates [Hz] by names of runs.
    source : JointSource
    """
    for run in runs:
        went = way(run.signals["q"], run.signals["omega"])
        if run.name not in measured:
            if abs(went.by_angle) < LEAST_MOVED:
                yield _rate_of_others(run, abs(went.by_angle))
            continue
        if abs(went.by_angle) >= LEAST_MOVED:
            yield from _sign(run, went)
        names = {each.name for each in runs if each.session == run.session}
        rates = [measured[name] for name in names if name in measured]
        references = []
        if len(rates) >= FEWEST_FOR_MEDIAN:
            references.append((float(np.median(rates)), "as in most runs of the session"))
        if source.rate_hz is not None:
            references.append((source.rate_hz, "as rate_hz says"))
        if not references and len(measured) >= FEWEST_FOR_MEDIAN:
            references.append((float(np.median(list(measured.values()))), "as in most runs of all sessions"))
        found = [
            _scale(run, reference / measured[run.name], f"its velocity says at {reference:.0f} Hz, {says}")
            for reference, says in references
        ]
        yield from [each for each in found if each is not None][:1]


def _rate_of_others(run: Run, moved: float) -> Defect:
    return Defect(
        "rate_of_others", "warn", run.label, "q", f"an angle that goes {moved:.2g} rad", f"at least {LEAST_MOVED} rad",
        "its rate is the median of the other runs; say rate_hz if it is known",
    )  # fmt: skip


def no_rate(run: Run) -> Defect:
    """Of a run whose rate neither its motion nor that of others nor the source says."""
    return Defect(
        "no_rate", "refuse", run.label, "", f"no run that moved by {LEAST_MOVED} rad, from which the rate would come",
        "a rate", "say rate_hz in the source",
    )  # fmt: skip


def _sign(run: Run, went: Way) -> Iterator[Defect]:
    if went.by_angle * went.by_velocity < 0:
        yield Defect(
            "velocity_backwards", "refuse", run.label, "omega", "a velocity against the sense of the angle",
            "both in one sense", "say inverted: true of the velocity or of the angle, whichever is wrong",
        )  # fmt: skip


def _scale(run: Run, ratio: float, said: str) -> Defect | None:
    """What a ratio of the way by the angle to that by the velocity means; None if they agree."""
    off = abs(ratio - 1)
    if off <= SCALE_WARNS:
        return None
    known = mistake(ratio, run.joint.gear_ratio)
    kind, reason = known or ("velocity_scale", f"a unit is wrong, or rows are missing; a factor of {ratio:.4g} fits")
    refuses = known is not None or off > SCALE_REFUSES
    return Defect(
        kind, "refuse" if refuses else "warn", run.label, "omega",
        f"an angle that goes {ratio:.4g} times as far as {said}", "1 time",
        f"likely {reason}; correct the source, or leave the file out",
    )  # fmt: skip
