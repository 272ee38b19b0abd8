"""The answer as ``report.json``: effects with intervals, errors before and after, and open questions."""

from collections.abc import Sequence
from datetime import datetime
from importlib.metadata import version
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.common.numbers import estimate, number
from swgsim.effects.base import Effect
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.errors import noise_floor
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.unit import UNHEARD
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.found_effects import alternatives, found_effects, options, small
from swgsim.identification.report.next_experiment import Experiment
from swgsim.identification.report.open_questions import absorbed, detectable, next_experiment, scored, unknown, untried
from swgsim.identification.report.prediction_errors import error, named
from swgsim.identification.report.sentence import sentence
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.recording import CHANNELS


def report(
    answer: Answer,
    kinds: Sequence[type[Effect]],
    experiments: Sequence[Experiment] = (),
    defects: Sequence[Defect] = (),
    seconds: float = 0.0,
    source: str = "recordings",
) -> dict[str, Any]:
    """The answer as plain numbers and text; unknown values are None.

    Parameters
    ----------
    answer : Answer
    kinds : sequence of effect classes
        The library that was searched.
    experiments : sequence of Experiment
        Recordings that would separate the alternatives or test absorbed effects.
    defects : sequence of Defect
        Warnings about the recordings.
    seconds : float
        Computing time of the answer.
    source : str
        Name of the recordings, such as their folder.
    """
    before, after = answer.decision.before, answer.decision.after
    measured = before.measured
    unheard = _orders(before, before.unit.inflation, UNHEARD / 2)
    effects = found_effects(answer)
    return {
        "verdict": answer.verdict,
        "sentence": sentence(answer, effects),
        "probability": number(answer.decision.probability),
        "noise_floor": named(measured, noise_floor(measured)),
        "calibrated": calibrated(after),
        "effects": effects,
        "small": small(answer),
        "alternatives": alternatives(answer),
        "options": options(answer),
        "error": error(before, after),
        "unknown": unknown(answer),
        "next_experiment": next_experiment(experiments, answer),
        "moved": moved(before, after),
        "absorbed": [absorbed(each) for each in answer.absorbed] + untried(answer, kinds),
        "detectable": {each.hypothesis.kind.name(): detectable(each) for each in answer.decision.scores},
        "scores": [scored(each) for each in answer.decision.scores],
        "commissioned": before.unit.commissioned,
        "structure": before.unit.structure,
        "learned": _orders(before, before.unit.learned, 0.0),
        "discrepancy": _discrepancy(before),
        "unheard": list(unheard),
        "zeros": measured.zeros,
        "channels": {name: CHANNELS[name].unit for name in measured.layout.channels},
        "recordings": _recordings(measured),
        "defects": [str(defect) for defect in defects],
        "seconds": round(seconds, 1),
        "made": {
            "date": datetime.now().astimezone().strftime("%Y-%m-%d %H:%M"),
            "recordings": source,
            "commissioning": None,
            "nominal": f"gear {(before.unit.nominal or before.model.gear).number}",
            "version": version("swg-workbench"),
        },
    }


def _orders(fitted: Fitted, values: Float[np.ndarray, " feature"] | None, limit: float) -> dict[str, list[int]]:
    """Orders of every channel at which a value exceeds a limit."""
    if values is None:
        return {}
    layout, more = fitted.measured.layout, values > limit
    found = {channel: layout.order[more & (layout.channel == channel)] for channel in layout.channels}
    return {channel: np.unique(orders).tolist() for channel, orders in found.items() if len(orders)}


def _discrepancy(fitted: Fitted) -> dict[str, float]:
    """Standard deviation of the model discrepancy of every channel that has one, as a share of its lines."""
    found = fitted.unit.discrepancy
    channels = fitted.measured.layout.channels
    return {name: float(sd) for name, sd in zip(channels, found.sd, strict=True) if sd} if found else {}


def calibrated(fitted: Fitted) -> dict[str, dict[str, Any]]:
    """The declared parameters of the model with their 95 % intervals."""
    unit = fitted.unit
    if unit.reach is None or unit.nominal is None:
        declared = fitted.declared
        deviations = [fitted.deviation[name] for name in declared]
    else:
        # In units of the prior standard deviations of the nominal gear.
        declared = unit.declared
        spread = np.sqrt((unit.reach**2).sum(axis=1))[: len(declared)].tolist()
        deviations = [s * p.sd for s, p in zip(spread, declared.values(), strict=True)]
    return {
        name: estimate(p.value(fitted.model), deviation, p.unit)
        for (name, p), deviation in zip(declared.items(), deviations, strict=True)
    }


def moved(before: Fitted, after: Fitted) -> dict[str, dict[str, Any]]:
    """Declared parameters that the effects moved by more than two standard deviations; they were biased before."""
    found = {}
    for name, parameter in before.declared.items():
        was, now = parameter.value(before.model), parameter.value(after.model)
        if abs(now - was) > 2 * after.deviation[name]:
            found[name] = {"before": was, "after": now, "unit": parameter.unit}
    return found


def _recordings(measured: Measured) -> dict[str, Any]:
    """Number, gear, sessions, operating points and repeats of the recordings."""
    groups = [measured.repeats.count(group) for group in dict.fromkeys(measured.repeats)]
    points = dict.fromkeys(recording.point for recording in measured.recordings)
    return {
        "count": len(measured),
        "gear": measured.recordings[0].gear,
        "sessions": len(measured.sessions),
        "operating_points": [{"n_in_rpm": float(p.n_in_rpm), "T_out_nm": float(p.T_out)} for p in points],
        "repeats": {"fewest": min(groups), "most": max(groups)},
    }
