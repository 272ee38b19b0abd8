"""Open questions: the unknown remainder, untestable effects, detection limits, and the next experiment."""

from collections.abc import Sequence
from typing import Any

from swgsim.common.numbers import number
from swgsim.effects.base import Effect
from swgsim.effects.quantity import quantities
from swgsim.effects.text import entries, path_of
from swgsim.identification.interharmonics.named_interharmonics import acts_on_signals, is_random
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.found_effects import in_words
from swgsim.identification.report.next_experiment import Experiment
from swgsim.identification.search.regularities import Described
from swgsim.identification.search.screening import Score


def unknown(answer: Answer) -> dict[str, Any] | None:
    """The remainder that no effect of the library explains, in words and numbers, and as effects that can be declared.

    ``orders`` are the orders of regularities and of interharmonic lines; ``pattern`` and ``law`` are those of the first
    regularity, or of the first interharmonic line if there is no regularity.
    """
    if not answer.unexplained:
        return None
    atoms = [_described(each) for each in answer.unknown]
    lines = [_line(each) for each in answer.unnamed]
    leading = next(iter(atoms or (line["parts"][0] for line in lines)), {"pattern": None, "law": None})
    orders = {each["order"] for each in atoms} | {line["at"] for line in lines if line["kind"] == "order"}
    return {
        "words": answer.unexplained,
        "orders": sorted(orders),
        "pattern": leading["pattern"],
        "law": leading["law"],
        "regularities": atoms,
        "lines": lines,
        "effects": entries([*(each.effect for each in answer.unknown), *answer.bare_lines]),
        "nearest": _nearest(answer),
    }


def _nearest(answer: Answer) -> dict[str, Any] | None:
    if answer.nearest is None:
        return None
    option, probability = answer.nearest
    return {"words": in_words(option), "probability": number(probability)}


def _described(each: Described) -> dict[str, Any]:
    return {
        "words": str(each),
        "order": int(each.atom.order),
        "pattern": each.atom.pattern,
        "law": each.atom.law,
        "rivals": list(each.rivals),
        "amplitude": number(each.amplitude),
        "phase": number(each.phase),
        "chance": number(each.chance),
    }


def _line(line: Unnamed) -> dict[str, Any]:
    return {
        "words": str(line),
        "kind": line.kind,
        "at": number(line.at),
        "reach": number(line.reach),
        "chance": number(line.chance),
        "parts": [
            {
                "words": str(part),
                "pattern": part.effect.pattern,
                "law": part.effect.law,
                "rivals": list(part.rivals),
                "amplitude": number(part.effect.amplitude),
            }
            for part in line.parts
        ],
    }


def next_experiment(experiments: Sequence[Experiment], answer: Answer) -> dict[str, Any] | None:
    """The next recordings, those with the fewest recordings first; None without an open question."""
    helpful = sorted((e for e in experiments if e.recordings), key=lambda e: (e.recordings or 0, -e.separation))
    helpless = [e for e in experiments if not e.recordings]
    words = [str(e) for e in (*helpful, *helpless)]
    commission = bool(helpless or answer.unexplained) and not answer.decision.before.unit.commissioned
    if commission:
        words.append("commission the gear with recordings of its healthy state (commissioning=FOLDER)")
    if not words:
        return None
    return {
        "words": "; ".join(words),
        "commission": commission,
        "questions": [
            {
                "between": list(e.between),
                "n_in_rpm": float(e.situation.point.n_in_rpm),
                "T_out_nm": float(e.situation.point.T_out),
                "temperature_c": float(e.situation.conditions.temperature),
                "elapsed_s": float(e.situation.conditions.elapsed),
                "recordings": e.recordings,
                "separation": number(e.separation),
            }
            for e in (*helpful, *helpless)
        ],
    }


def absorbed(score: Score) -> dict[str, Any]:
    """An effect that these recordings cannot test."""
    return {
        "name": path_of(score.hypothesis.kind),
        "visible": number(score.visible),
        "why": (
            "it does not change the recorded channels at the recorded operating points"
            if score.visible <= 0
            else "no size within its bounds would be significant at the recorded operating points; nuisance parameters "
            f"absorb {100 * (1 - score.visible):.3g} % of its signature"
        ),
    }


def untried(answer: Answer, kinds: Sequence[type[Effect]]) -> list[dict[str, Any]]:
    """Effects for which there is no test."""
    gauges = any(channel.startswith("s") for channel in answer.decision.before.measured.layout.channels)
    whys = {
        kind: "its phase is random in every recording, and no gauge is in all recordings"
        if acts_on_signals(kind)
        else "its phase is random in every recording and it acts inside the chain: there is no test for it"
        for kind in kinds
        if is_random(kind) and not (gauges and acts_on_signals(kind))
    }
    return [{"name": path_of(kind), "visible": None, "why": why_not} for kind, why_not in whys.items()]


def detectable(score: Score) -> dict[str, Any]:
    """The detection limit, relative to the size without effect; None if it lies beyond the bounds."""
    q = quantities(score.hypothesis.kind)[score.hypothesis.size]
    return {
        "parameter": score.hypothesis.size,
        "value": number(score.value_at_limit) if score.within_bounds else None,
        "typical": float(q.typical),
        "unit": q.unit,
        "typical_would_be_seen": bool(score.detectable <= abs(q.typical - q.nothing)),
    }


def scored(score: Score) -> dict[str, Any]:
    """Score of one effect in the first search."""
    return {
        "name": path_of(score.hypothesis.kind),
        "place": score.hypothesis.kind.place,
        "score": number(score.gain),
        "freedom": int(score.freedom),
        "chance": number(score.chance),
        "visible": number(score.visible),
    }
