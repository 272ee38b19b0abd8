"""The answer for a joint as ``report.json``: what its textbook model lacks, what each effect bought, what remains."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.effects.quantity import Role, quantities
from swgsim.joint.days import Days
from swgsim.joint.effects.position_friction import PositionFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.judged import Judged, Rung
from swgsim.joint.naming import in_words, listed
from swgsim.joint.recording import SIGNALS
from swgsim.joint.regression import Fit, rms
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.term import Term
from swgsim.joint.waves import SLOW

# Probability below which sessions differ in friction.
DIFFERENT = 0.02
# No strain wave gear has a smaller ratio.
SLOWEST = 30


def report(judged: Judged, days: Days | None, lines: Sequence[RemainingLine]) -> dict[str, Any]:
    """All that is said of a joint, as plain numbers and text; what is not known is None."""
    first, top, unit = judged.table.recordings[0], judged.ladder.top, SIGNALS[judged.table.of].unit
    steps = len(judged.ladder.steps)
    words = [*map(str, lines), *([_of_days(days)] if days and days.chance < DIFFERENT else [])]
    return {
        "verdict": FOUND if steps else UNKNOWN if words else NOTHING,
        "sentence": sentence(judged, words),
        "lacks": listed([step.term for step in judged.ladder.steps], first.gear_ratio),
        "robot": first.robot,
        "joint": first.joint,
        "signal": judged.table.of,
        "unit": unit,
        "split": {
            "fit": [each.name for each in judged.table.recordings],
            "heldout": [each.name for each in judged.heldout.recordings],
        },
        "noise_floor": judged.floor,
        "gear_ratio": gear_ratio(judged),
        "calibrated": _weights(top, 0, len(judged.ladder.textbook.terms), unit),
        "effects": [
            {
                "name": rung.trial.term.name(),
                "title": in_words(rung.trial.term, first.gear_ratio),
                "place": "joint",
                "parameters": _shape(term) | _weights(top, number, number + 1, unit),
                "evidence": {"gain": rung.trial.gain, "worst_session": rung.trial.worst, "chance": rung.trial.chance},
                "indistinguishable_from": [],
            }
            for number, (rung, term) in enumerate(
                zip(judged.rungs[1 : steps + 1], top.terms[-steps:] if steps else (), strict=True),
                len(judged.ladder.textbook.terms),
            )
            if rung.trial
        ],
        "rejected": [
            {"name": r.trial.term.name(), "title": in_words(r.trial.term, first.gear_ratio), "heldout_error": r.heldout,
             "why": r.trial.why}
            for r in judged.rungs if r.trial and not r.kept
        ],
        "rungs": [_rung(rung, first.gear_ratio) for rung in judged.rungs],
        "error": {
            "before": _errors(judged.before), "after": _errors(judged.after), "noise_floor": judged.floor, "unit": unit,
        },
        "runs": runs(judged),
        "days": None if days is None else {
            "sessions": [vars(day) for day in days.days], "chance": days.chance, "spread": days.spread,
        },
        "unknown": {"words": words, "lines": [vars(line) for line in lines]} if words else None,
        "next_experiment": _next(judged, days),
    }  # fmt: skip


def sentence(judged: Judged, left: Sequence[str]) -> str:
    """The verdict in one sentence."""
    ratio, of = judged.table.recordings[0].gear_ratio, SIGNALS[judged.table.of]
    where = f"{judged.table.recordings[0].robot}, {judged.table.recordings[0].joint.replace('_', ' ')}, {of.says}"
    more = "one regularity in what is left remains" if len(left) == 1 else f"{len(left)} regularities remain"
    rest = f"; {more} unexplained" if left else ""
    if not judged.ladder.steps:
        return f"{where}: no effect of the library helps the textbook model on recordings it has not seen{rest}."
    terms = [step.term for step in judged.ladder.steps]
    return (
        f"{where}: the textbook model lacks {listed(terms, ratio)}; with {'them' if terms[1:] else 'it'} the error on "
        f"recordings not seen falls from {judged.before.heldout:.3g} to {judged.after.heldout:.3g} {of.unit}{rest}."
    )


def runs(judged: Judged) -> list[dict[str, Any]]:
    """Error of every recording before and after."""
    found = []
    for table, heldout in ((judged.table, False), (judged.heldout, True)):
        before, after = judged.ladder.textbook.missed(table), judged.ladder.top.missed(table)
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


def gear_ratio(judged: Judged) -> dict[str, Any] | None:
    """As declared; else the largest number of which all fast orders that were found are multiples, if there are two."""
    known = judged.table.recordings[0].gear_ratio
    if known is not None:
        return {"value": known, "ci95": None, "how": "declared"}
    waves = [step.term for step in judged.ladder.steps if isinstance(step.term, Ripple | PositionFriction)]
    orders = sorted({wave.order for wave in waves if wave.order > SLOW})
    if len(orders) < 2:
        return None
    doubt = np.pi / max(float(np.ptp(each.signals["q"])) for each in judged.table.recordings)
    for ratio in (orders[0] / k for k in range(1, int(orders[0] / SLOWEST) + 1)):
        if all(abs(order - round(order / ratio) * ratio) <= doubt for order in orders):
            half = doubt * ratio / orders[-1]
            return {
                "value": ratio,
                "ci95": [ratio - half, ratio + half],
                "how": "read off the ripple: the largest number that divides all fast orders; the ratio or a multiple",
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
        for number, weight in enumerate(term.weights):
            half = float(top.half_interval[start + number])
            name = term.name() if len(term.weights) == 1 else f"{term.name()} {number + 1}"
            own = units[number] if len(units) > 1 else units[0]
            found[name] = {"value": weight, "ci95": [weight - half, weight + half], "unit": own}
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
    """Inner parameters, of which no interval is known; a filter that is open is none."""
    declared = {n: q for n, q in quantities(type(term)).items() if q.role in (Role.SHAPE, Role.CHOICE)}
    if isinstance(term, Ripple) and term.corner == declared["corner"].high:
        declared = {name: q for name, q in declared.items() if name not in ("corner", "damping")}
    return {n: {"value": float(getattr(term, n)), "ci95": None, "unit": q.unit} for n, q in declared.items()}


def _rung(rung: Rung, ratio: float | None) -> dict[str, Any]:
    return {
        "effect": rung.trial.term.name() if rung.trial else "textbook",
        "title": in_words(rung.trial.term, ratio) if rung.trial else "textbook model",
        **_errors(rung),
        "kept": rung.kept,
        "why": "" if rung.kept or not rung.trial else rung.trial.why,
    }


def _errors(rung: Rung) -> dict[str, float]:
    return {"fit": rung.fit, "heldout": rung.heldout, "heldout_slow": rung.heldout_slow}


def _of_days(days: Days) -> str:
    """How friction differs between sessions, and what that does not say."""
    share = f"{100 * days.spread:.0f} % (chance {days.chance:.1g})"
    return (
        f"friction that rises with speed differs between sessions by {share}, as grease at another temperature would "
        "make it, but no temperature was recorded, so the cause is not known"
    )


def _next(judged: Judged, days: Days | None) -> dict[str, Any] | None:
    """What to record next, where something is open."""
    wishes = []
    if days and days.chance < DIFFERENT:
        wishes.append("log the temperature of the joint, and record one session cold and warm on the same day")
    if judged.floor is None:
        wishes.append("record the joint at rest, for the noise of its signals")
    unsteady = [r.trial.term for r in judged.rungs if r.trial and not r.kept and r.trial.unsteady]
    if unsteady:
        ratio = judged.table.recordings[0].gear_ratio
        wishes.append(f"record more sessions, to decide about {listed(unsteady, ratio)}")
    return {"words": "; ".join(wishes)} if wishes else None
