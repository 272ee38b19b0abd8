"""The answer as ``report.json``: what was found, how well it is known, what it changes, and what remains open."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.defect import Defect
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.effects.text import path_of
from swgsim.loop.answer import UNKNOWN, Answer
from swgsim.loop.closing import LEAST_GAIN, Step, Trial
from swgsim.loop.declared import of_unit
from swgsim.loop.errors import errors, noise_floor, per_channel
from swgsim.loop.experiment import Experiment
from swgsim.loop.fitting import Fitted
from swgsim.loop.screening import Score
from swgsim.loop.session import Measured
from swgsim.loop.sidelines import Sideline
from swgsim.loop.vocabulary import Described
from swgsim.recording import CHANNELS

# Standard deviations to either side of a value that hold it in 95 of 100 cases.
NORMAL = 1.96
UNIT = "% of the root mean square of each channel, root mean square over the channels"


@dataclass(frozen=True, eq=False)
class Sizes:
    """Errors per channel beside what makes them comparable.

    Attributes
    ----------
    channels : tuple of str
    scale : array (channel,)
        Root mean square of each channel, in its unit.
    """

    channels: tuple[str, ...]
    scale: Float[np.ndarray, " channel"]

    @classmethod
    def of(cls, measured: Measured) -> "Sizes":
        """Of recordings."""
        return cls(measured.layout.channels, per_channel(measured, measured.values.ravel()))

    def overall(self, error: Float[np.ndarray, " channel"]) -> float | None:
        """One figure for all channels [UNIT]; None where it is not known."""
        return number(100 * float(np.sqrt(np.mean((error / self.scale) ** 2))))

    def named(self, error: Float[np.ndarray, " channel"]) -> dict[str, float | None]:
        """The error of every channel by its name, in the channel's unit."""
        return {name: number(value) for name, value in zip(self.channels, error.tolist(), strict=True)}


def report(
    answer: Answer,
    kinds: Sequence[type[Effect]],
    experiments: Sequence[Experiment] = (),
    defects: Sequence[Defect] = (),
    seconds: float = 0.0,
) -> dict[str, Any]:
    """All that closing the loop says, as plain numbers and text; what is not known is None.

    Parameters
    ----------
    answer : Answer
    kinds : sequence of effect classes
        The library that was searched.
    experiments : sequence of Experiment
        What would separate what these recordings cannot.
    defects : sequence of Defect
        What was detected in the recordings.
    seconds : float
        That the answer took.
    """
    before, after = answer.closed.before, answer.closed.after
    measured = before.measured
    sizes = Sizes.of(measured)
    floor = noise_floor(measured)
    return {
        "verdict": answer.verdict,
        "sentence": answer.sentence,
        "noise_floor": sizes.named(floor),
        "calibrated": calibrated(after),
        "effects": [*_accepted(answer), *(_of_line(line) for line in answer.lines)],
        "rejected": _rejected(answer, sizes),
        "error": _error(before, after, floor, sizes),
        "unknown": _unknown(answer),
        "next_experiment": _next(experiments, before.unit.commissioned),
        "moved": moved(before, after),
        "absorbed": [_absorbed(score) for score in answer.absorbed] + _untried(answer, kinds),
        "detectable": {score.hypothesis.kind.name(): _detectable(score) for score in answer.closed.scores},
        "scores": [_score(score) for score in answer.closed.scores],
        "commissioned": before.unit.commissioned,
        "channels": {name: CHANNELS[name].unit for name in measured.layout.channels},
        "recordings": _recordings(measured),
        "defects": [str(defect) for defect in defects],
        "seconds": round(seconds, 1),
    }


def number(value: float) -> float | None:
    """A number as JSON knows it: None for one that is not finite."""
    return float(value) if isfinite(value) else None


def names(trial: Trial) -> str:
    """The effects of a trial by their registered names."""
    return " and ".join(path_of(type(effect)) for effect in trial.effects)


def probability(value: float) -> str:
    """A small probability in words.

    >>> probability(0.012), probability(0.0)
    ('0.01', 'below 1e-300')
    """
    return f"{value:.1g}" if value > 1e-300 else "below 1e-300"


def calibrated(fitted: Fitted) -> dict[str, dict[str, Any]]:
    """The declared parameters at which the chain ran, with what is left open of them."""
    unit = fitted.unit
    if unit.reach is None:
        declared = {name: p for name, p in fitted.parameters.items() if ": " not in name}
        deviations = [fitted.deviation[name] for name in declared]
    else:
        declared = of_unit(unit.model.gear)
        spread = np.sqrt((unit.reach**2).sum(axis=1))[: len(declared)].tolist()
        deviations = [s * p.sd for s, p in zip(spread, declared.values(), strict=True)]
    return {
        name: estimate(p.value(fitted.model), deviation, p.unit)
        for (name, p), deviation in zip(declared.items(), deviations, strict=True)
    }


def estimate(value: float, deviation: float, unit: str, low: float = -np.inf, high: float = np.inf) -> dict[str, Any]:
    """A value with its interval, which ends where the parameter's bounds are."""
    interval = [max(value - NORMAL * deviation, low), min(value + NORMAL * deviation, high)]
    return {"value": number(value), "ci95": [number(end) for end in interval], "unit": unit}


def moved(before: Fitted, after: Fitted) -> dict[str, dict[str, Any]]:
    """Declared parameters that adding the effects has moved by more than two standard deviations.

    Calibration had bent them to hide what was missing.
    """
    found = {}
    for name, parameter in before.parameters.items():
        was, now = parameter.value(before.model), parameter.value(after.model)
        if ": " not in name and abs(now - was) > 2 * after.deviation[name]:
            found[name] = {"before": was, "after": now, "unit": parameter.unit}
    return found


def _accepted(answer: Answer) -> list[dict[str, Any]]:
    """The effects that were added, with their evidence and their rivals."""
    after, found = answer.closed.after, []
    at = len(answer.closed.before.model.effects)
    for step in answer.closed.steps:
        for which in range(len(step.accepted.effects)):
            effect = after.model.effects[at]
            found.append({
                "name": path_of(type(effect)),
                "place": effect.place,
                "parameters": _parameters(effect, after.deviation, at),
                "evidence": _evidence(step, which),
                "indistinguishable_from": [names(rival) for rival in step.rivals],
                "rivals": [_rival(rival) for rival in step.rivals],
            })  # fmt: skip
            at += 1
    return found


def _parameters(effect: Effect, deviation: Mapping[str, float], number_: int) -> dict[str, dict[str, Any]]:
    """Parameters of the effect with that number in its model; those that were chosen or fixed have no interval."""
    found = {}
    for name, q in quantities(type(effect)).items():
        value = getattr(effect, name)
        spread = deviation.get(f"{effect.title()} {number_ + 1}: {name}")
        if spread is None:
            found[name] = {"value": number(value), "ci95": None, "unit": q.unit}
        elif q.role in (Role.PHASE, Role.ANGLE):
            found[name] = estimate(value, spread, q.unit)
        else:
            found[name] = estimate(value, spread, q.unit, q.low, q.high)
    return found


def _rival(trial: Trial) -> dict[str, Any]:
    """Another explanation that these recordings cannot rule out, at its likeliest parameters."""
    first = len(trial.fitted.model.effects) - len(trial.effects)
    return {
        "effects": [
            {"name": path_of(type(e)), "parameters": _parameters(e, trial.fitted.deviation, first + i)}
            for i, e in enumerate(trial.effects)
        ],
        "heldout_gain": number(trial.gain),
    }  # fmt: skip


def _evidence(step: Step, which: int) -> dict[str, Any]:
    """Why an effect is believed."""
    trial, score = step.accepted, step.accepted.score
    agreement = trial.coherence[which]
    together = " (together with the other effect of the pair)" if len(trial.effects) > 1 else ""
    return {
        "words": (
            f"adding it{together} raises the log-likelihood of operating points left out by {trial.gain:.0f} "
            f"(at least {LEAST_GAIN:g} are asked for); so high a score comes by luck with probability "
            f"{probability(score.chance)} in the whole library; one size serves all operating points, "
            f"channels and orders, with parts that differ by {100 * agreement.form_error:.0f} %"
        ),
        "heldout_gain": number(trial.gain),
        "score": number(score.gain),
        "chance": number(score.chance),
        "visible": number(score.visible),
        "coherence": {"chance": number(agreement.chance), "form_error": number(agreement.form_error)},
    }


def _of_line(line: Sideline) -> dict[str, Any]:
    """An effect between the orders; its phase is another one in every recording."""
    effect = line.effect
    parameters = {}
    for name, q in quantities(type(effect)).items():
        value = getattr(effect, name)
        if q.role is Role.SIZE:
            parameters[name] = estimate(value, line.deviation, q.unit, q.low, q.high)
        elif q.role is not Role.RANDOM:
            parameters[name] = {"value": number(value), "ci95": None, "unit": q.unit}
    return {
        "name": path_of(type(effect)),
        "place": effect.place,
        "parameters": parameters,
        "evidence": {
            "words": (
                f"lines between the integer orders that come by luck with probability {probability(line.chance)}; "
                f"its law over load and speed agrees with all recordings (probability {line.agrees:.2g})"
            ),
            "score": number(line.gain),
            "chance": number(line.chance),
            "coherence": {"chance": number(line.agrees), "form_error": None},
        },
        "indistinguishable_from": [],
        "rivals": [],
    }


def _rejected(answer: Answer, sizes: Sizes) -> list[dict[str, Any]]:
    """Effects that were fitted but not added."""
    steps = answer.closed.steps
    # What was put off in one step may be found, or be a rival, in a later one.
    held = {names(trial) for step in steps for trial in (step.accepted, *step.rivals)}
    tried: dict[str, tuple[Trial, Trial | None]] = {
        names(trial): (trial, step.accepted) for step in steps for trial in step.others if names(trial) not in held
    }
    tried |= {names(trial): (trial, None) for trial in answer.closed.rejected}
    return [
        {
            "name": name,
            "heldout_error": sizes.overall(errors(trial.fitted).heldout),
            "why": _why(trial, accepted),
        }
        for name, (trial, accepted) in tried.items()
    ]


def _why(trial: Trial, accepted: Trial | None) -> str:
    """Why a trial was not accepted, in words."""
    if not trial.fitted.calibrated.settled:
        return "its fit did not come to rest"
    poorest = min(trial.coherence, key=lambda each: each.chance)
    if not poorest.holds:
        form = f"; its form differs by {100 * poorest.form_error:.0f} %" if poorest.form_error else ""
        return (
            "one size does not serve all operating points, channels and orders "
            f"(probability {probability(poorest.chance)}{form})"
        )
    if trial.gain <= LEAST_GAIN:
        return (
            f"it does not help to predict operating points left out: log-likelihood {trial.gain:+.1f}, "
            f"at least {LEAST_GAIN:g} are asked for"
        )
    if accepted is None:
        return "it was sound only beside an effect that was not"
    return (
        f"it predicts operating points left out worse than {' and '.join(e.title() for e in accepted.effects)}: "
        f"log-likelihood {trial.gain:+.0f} against {accepted.gain:+.0f}"
    )


def _error(before: Fitted, after: Fitted, floor: Float[np.ndarray, " channel"], sizes: Sizes) -> dict[str, Any]:
    """Errors before and after, of what was fitted and of operating points left out."""
    found = {"before": errors(before), "after": errors(after)}
    return {
        **{
            name: {"fit": sizes.overall(each.fit), "heldout": sizes.overall(each.heldout)}
            for name, each in found.items()
        },
        "noise_floor": sizes.overall(floor),
        "unit": UNIT,
        "per_channel": {
            channel: {
                **{
                    name: {"fit": number(each.fit[i]), "heldout": number(each.heldout[i])}
                    for name, each in found.items()
                },
                "noise_floor": number(floor[i]),
                "root_mean_square": number(sizes.scale[i]),
                "unit": CHANNELS[channel].unit,
            }
            for i, channel in enumerate(sizes.channels)
        },
    }


def _unknown(answer: Answer) -> dict[str, Any] | None:
    """What no effect of the library explains, in words and numbers."""
    if not answer.unknown and answer.verdict != UNKNOWN:
        return None
    atoms = [_described(each) for each in answer.unknown]
    nearest = answer.nearest
    return {
        "words": "; ".join(each["words"] for each in atoms) or "a regularity without a simple description",
        "orders": sorted({each["order"] for each in atoms}),
        "pattern": atoms[0]["pattern"] if atoms else None,
        "law": atoms[0]["law"] if atoms else None,
        "regularities": atoms,
        "nearest": {"name": names(nearest), "why": _why(nearest, None)} if nearest else None,
    }


def _described(each: Described) -> dict[str, Any]:
    return {
        "words": str(each),
        "order": int(each.atom.order),
        "pattern": each.atom.pattern,
        "law": each.atom.law,
        "amplitude": number(each.amplitude),
        "phase": number(each.phase),
        "chance": number(each.chance),
    }


def _next(experiments: Sequence[Experiment], commissioned: bool) -> dict[str, Any] | None:
    """What to record next, the question that needs the fewest recordings first; None if nothing is open."""
    if not experiments:
        return None
    helpful = sorted((e for e in experiments if e.recordings), key=lambda e: (e.recordings or 0, -e.separation))
    helpless = [e for e in experiments if not e.recordings]
    words = [str(e) for e in (*helpful, *helpless)]
    if helpless and not commissioned:
        words.append("commissioning=FOLDER with recordings of the healthy gear would take such doubt away")
    return {
        "words": "; ".join(words),
        "questions": [
            {
                "between": list(e.between),
                "n_in_rpm": float(e.point.n_in_rpm),
                "T_out_nm": float(e.point.T_out),
                "recordings": e.recordings,
                "separation": number(e.separation),
            }
            for e in (*helpful, *helpless)
        ],
    }


def _absorbed(score: Score) -> dict[str, Any]:
    """An effect that these recordings cannot show."""
    return {
        "name": path_of(score.hypothesis.kind),
        "visible": number(score.visible),
        "why": (
            "these recordings do not show it: the channels do not see it at the recorded operating points"
            if score.visible <= 0
            else "declared parameters can imitate it at the recorded operating points: only "
            f"{100 * score.visible:.2g} % of its signature is left beside them"
        ),
    }


def _untried(answer: Answer, kinds: Sequence[type[Effect]]) -> list[dict[str, Any]]:
    """Effects that no test looks at."""
    screened = {score.hypothesis.kind for score in answer.closed.scores}
    between = {type(line.effect) for line in answer.lines}
    return [
        {
            "name": path_of(kind),
            "visible": None,
            "why": "its phase is another one in every recording and it acts inside the chain: there is no test for it",
        }
        for kind in kinds
        if kind not in screened | between and not _on_signals(kind)
    ]


def _on_signals(kind: type[Effect]) -> bool:
    return any(getattr(kind, place) is not getattr(Effect, place) for place in ("gauge", "acquisition"))


def _detectable(score: Score) -> dict[str, Any]:
    """The smallest size that would have been seen, counted from the one that changes nothing."""
    q = quantities(score.hypothesis.kind)[score.hypothesis.size]
    smallest = q.nothing + float(np.copysign(score.detectable, q.typical - q.nothing))
    return {
        "parameter": score.hypothesis.size,
        "value": number(smallest),
        "typical": float(q.typical),
        "unit": q.unit,
        "typical_would_be_seen": bool(score.detectable <= abs(q.typical - q.nothing)),
    }


def _score(score: Score) -> dict[str, Any]:
    """Score of one effect in the first search."""
    return {
        "name": path_of(score.hypothesis.kind),
        "place": score.hypothesis.kind.place,
        "score": number(score.gain),
        "freedom": int(score.freedom),
        "chance": number(score.chance),
        "visible": number(score.visible),
    }


def _recordings(measured: Measured) -> dict[str, Any]:
    """What was recorded."""
    groups = [measured.repeats.count(group) for group in dict.fromkeys(measured.repeats)]
    points = dict.fromkeys(recording.point for recording in measured.recordings)
    return {
        "count": len(measured),
        "gear": measured.recordings[0].gear,
        "sessions": len(dict.fromkeys(recording.session for recording in measured.recordings)),
        "operating_points": [{"n_in_rpm": float(p.n_in_rpm), "T_out_nm": float(p.T_out)} for p in points],
        "repeats": {"fewest": min(groups), "most": max(groups)},
    }
