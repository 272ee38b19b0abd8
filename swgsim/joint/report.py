"""The answer for a joint as ``report.json``: missing effects, their value on held-out recordings, what remains."""

from collections.abc import Sequence
from inspect import getdoc
from typing import Any

import numpy as np

from swgsim.common.outcome import FOUND
from swgsim.effects.quantity import Role, quantities
from swgsim.joint.cautions import LEAST_GEAR_RATIO, cautions, differ, likely, next_experiment
from swgsim.joint.days import Days, no_days
from swgsim.joint.effects.friction import PositionFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.extrapolation import by_speed
from swgsim.joint.low_speed import in_sum
from swgsim.joint.naming import in_words, listed
from swgsim.joint.recording import SIGNALS
from swgsim.joint.regression import Fit, rms
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.term import Term
from swgsim.joint.validation import Rung, Validation
from swgsim.joint.verdict import explained, fails, sentence, verdict
from swgsim.joint.waves import SLOW


def report(
    validation: Validation, days: Days | None, lines: Sequence[RemainingLine], left_out: Sequence[str] = ()
) -> dict[str, Any]:
    """The answer as plain numbers and text; unknown values are None. ``left_out`` names recordings with the reason."""
    first, top, unit = validation.table.recordings[0], validation.ladder.top, SIGNALS[validation.table.of].unit
    ratio, steps, base = first.gear_ratio, validation.ladder.steps, len(validation.ladder.textbook.terms)
    words = [*map(str, lines), *([_friction_by_session(days)] if days and differ(days) else [])]
    share, word = validation.explained(validation.ladder.textbook), verdict(validation, words)
    return {
        "textbook_explains": share.value,
        "textbook_explains_ci95": [share.value - share.half, share.value + share.half],
        "explains": explained(validation),
        "verdict": word,
        "sentence": sentence(validation, words),
        "lacks": listed([step.term for step in validation.confirmed], ratio) if word == FOUND else "",
        "contradicted": listed([step.term for step in validation.contradicted], ratio),
        "robot": first.robot,
        "joint": first.joint,
        "signal": validation.table.of,
        "unit": unit,
        "split": {
            "fit": [each.name for each in validation.table.recordings],
            "heldout": [each.name for each in validation.heldout.recordings],
            "left_out": list(left_out),
        },
        "noise_floor": validation.floor,
        "gear_ratio": gear_ratio(validation),
        "calibrated": _weights(top, 0, base, unit),
        "friction_in_sum": in_sum(top, unit),
        "effects": [
            {
                "name": step.term.name(),
                "title": in_words(step.term, ratio),
                "meaning": " ".join((getdoc(type(step.term)) or "").partition("\n\n")[0].split()),
                "parameters": _shape(top.terms[number]) | _weights(top, number, number + 1, unit),
                "evidence": {"gain": step.gain, "worst_session": step.worst, "chance": step.chance},
            }
            for number, step in enumerate(steps, base)
        ],
        "rungs": _rungs(validation, ratio),
        "error": {
            "before": _errors(validation.before), "after": _errors(validation.after),
            "noise_floor": validation.floor, "unit": unit,
        },
        "runs": runs(validation),
        "speeds": by_speed(validation),
        "days": None if days is None else {
            "sessions": [vars(day) for day in days.days], "chance": days.chance, "spread": days.spread,
        },
        "no_days": "" if days else no_days((validation.table, validation.heldout)),
        "unknown": {"words": words, "lines": [vars(line) for line in lines]} if words else None,
        "cautions": cautions(validation, left_out),
        "likely": likely(validation) if fails(validation) else [],
        "next_experiment": next_experiment(validation, days),
    }  # fmt: skip


def runs(validation: Validation) -> list[dict[str, Any]]:
    """Error of every recording before and after."""
    found = []
    for table, heldout in ((validation.table, False), (validation.heldout, True)):
        before, after = validation.ladder.textbook.missed(table), validation.ladder.top.missed(table)
        for number, each in enumerate(table.recordings):
            own = table.run == number
            found.append(
                {
                    "run": each.name,
                    "session": each.session,
                    "heldout": heldout,
                    "speed": float(np.abs(each.speed).mean()),
                    "before": rms(before[own]),
                    "after": rms(after[own]),
                }
            )
    return found


def gear_ratio(validation: Validation) -> dict[str, Any] | None:
    """The declared ratio; else the largest number that divides all orders above SLOW, if there are two."""
    known = validation.table.recordings[0].gear_ratio
    if known is not None:
        return {"value": known, "ci95": None, "how": "declared"}
    waves = [step.term for step in validation.ladder.steps if isinstance(step.term, Ripple | PositionFriction)]
    orders = sorted({wave.order for wave in waves if wave.order > SLOW})
    if len(orders) < 2:
        return None
    doubt = np.pi / max(float(np.ptp(each.signals["q"])) for each in validation.table.recordings)
    for ratio in (orders[0] / k for k in range(1, int(orders[0] / LEAST_GEAR_RATIO) + 1)):
        if all(abs(order - round(order / ratio) * ratio) <= doubt for order in orders):
            half = doubt * ratio / orders[-1]
            return {
                "value": ratio,
                "ci95": [ratio - half, ratio + half],
                "how": "estimated from the ripple: the largest divisor of all fast orders; the ratio or a multiple",
            }
    return None


def _weights(top: Fit, first: int, last: int, unit: str) -> dict[str, dict[str, Any]]:
    """Weights of some terms with their 95 % intervals."""
    found: dict[str, dict[str, Any]] = {}
    start = sum(len(term.weights) for term in top.terms[:first])
    for term in top.terms[first:last]:
        units = term.units(unit)
        if isinstance(term, Ripple | PositionFriction):
            found |= _wave(term, top.half_interval[start : start + 2], units[0])
            start += 2
            continue
        each_unit = units if len(units) > 1 else units * len(term.weights)
        for number, (name, weight, own) in enumerate(zip(term.names(), term.weights, each_unit, strict=True)):
            half, least = float(top.half_interval[start + number]), float(top.least[start + number])
            found[name] = {"value": weight, "ci95": [max(weight - half, least), weight + half], "unit": own}
        start += len(term.weights)
    return found


def _wave(term: Ripple | PositionFriction, half: np.ndarray, unit: str) -> dict[str, dict[str, Any]]:
    """Amplitude and phase of a wave from half the intervals of its cosine and sine."""
    a, b = term.weights
    size, phase = float(np.hypot(a, b)), float(np.arctan2(b, a))
    along, across = (
        float(np.hypot(a * half[0], b * half[1])) / size,
        float(np.hypot(b * half[0], a * half[1])) / size**2,
    )
    return {
        "amplitude": {"value": size, "ci95": [size - along, size + along], "unit": unit},
        "phase": {"value": phase, "ci95": [phase - across, phase + across], "unit": "rad"},
    }


def _shape(term: Term) -> dict[str, dict[str, Any]]:
    """Inner parameters, without intervals; a filter without effect is left out."""
    declared = {n: q for n, q in quantities(type(term)).items() if q.role in (Role.SHAPE, Role.CHOICE)}
    if isinstance(term, Ripple) and term.corner == declared["corner"].high:
        declared = {name: q for name, q in declared.items() if name not in ("corner", "damping")}
    return {n: {"value": float(getattr(term, n)), "ci95": None, "unit": q.unit} for n, q in declared.items()}


def _rungs(validation: Validation, ratio: float | None) -> list[dict[str, Any]]:
    """Accepted and refused terms with their errors, and a remark where there is one."""
    found = []
    against = validation.contradicted
    for rung in validation.rungs:
        raises = rung.kept and any(rung.trial is trial for trial in against)
        remark = "contradicted: raises the error on held-out recordings" if raises else ""
        found.append(
            {
                "effect": rung.trial.term.name() if rung.trial else "textbook",
                "title": in_words(rung.trial.term, ratio) if rung.trial else "textbook model",
                **_errors(rung),
                "kept": rung.kept,
                "contradicted": raises,
                "why": remark if rung.kept or not rung.trial else rung.trial.why,
            }
        )
    return found


def _errors(rung: Rung) -> dict[str, float]:
    return {"fit": rung.fit, "heldout": rung.heldout, "heldout_slow": rung.heldout_slow}


def _friction_by_session(days: Days) -> str:
    """Difference of friction between sessions, in words."""
    share = f"{100 * days.spread:.0f} % (p-value {days.chance:.1g})"
    return (
        f"speed-dependent friction differs between sessions by {share}; grease at another temperature would explain "
        "it, but no temperature was recorded, so the cause is unknown"
    )
