"""The rate of each run from how fast its angle goes, where no clock was recorded."""

from collections.abc import Mapping, Sequence

import numpy as np

from swgsim.joint.intake.motion import way
from swgsim.joint.intake.run import Run
from swgsim.joint.intake.source import JointSource
from swgsim.joint.intake.thresholds import LEAST_MOVED


def measured_rates(runs: Sequence[Run]) -> dict[str, float]:
    """Mean velocity over mean step of the angle [Hz], by the names of the runs that moved enough to tell.

    Of several joints in a file the one that moved most says the rate.
    """
    furthest: dict[str, tuple[float, float]] = {}
    for run in runs:
        by_angle, by_velocity = way(run.signals["q"], run.signals["omega"])
        if abs(by_angle) >= LEAST_MOVED and by_velocity:
            furthest[run.name] = max(furthest.get(run.name, (0.0, 0.0)), (abs(by_angle), abs(by_velocity / by_angle)))
    return {name: rate for name, (_, rate) in furthest.items()}


def usual_rates(runs: Sequence[Run], measured: Mapping[str, float], source: JointSource) -> dict[str, float]:
    """What the rate of each run should be [Hz]: the declared one, or, where it comes from the motion, the median of its
    session, else of all runs, else the declared one; of no run if there is no clue, or if there is a clock.
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
