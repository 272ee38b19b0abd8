"""One case: recordings, answer, and the quantities that are scored."""

import resource
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from swgsim.blind.altered import resized
from swgsim.blind.baselines import named_by_baselines
from swgsim.blind.bench import Setting, in_question, unseen
from swgsim.blind.drawing import unit_known
from swgsim.blind.prediction import unseen_error
from swgsim.blind.sealed import Sealed
from swgsim.common.numbers import number
from swgsim.effects import text
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.decide.option import kind_of
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.form_error import signature
from swgsim.identification.fit.priors import name_of
from swgsim.identification.fit.unit import Unit
from swgsim.identification.interharmonics.named_interharmonics import is_random
from swgsim.identification.report.answer import Answer, answer
from swgsim.identification.report.found_effects import found_effects
from swgsim.identification.report.prediction_errors import heldout
from swgsim.identification.report.sentence import sentence
from swgsim.recordings.recording import Recording


def attempt(case: Sealed, setting: Setting) -> dict[str, Any]:
    """The answer to a case, and its errors at operating points that were not recorded."""
    began = time.perf_counter()
    unit = unit_known(case, setting)
    ready = time.perf_counter()
    recordings, library = in_question(case, setting, case.acting), setting.given(case)
    started = time.perf_counter(), time.process_time()
    found = answer(recordings, unit, library, interest=0.0, seed=case.number)  # detection is judged
    seconds = {
        "preparing": ready - began,
        "loop": time.perf_counter() - started[0],
        "loop_of_one_core": time.process_time() - started[1],
    }
    fields = answer_fields(found, recordings, library)
    return {**fields, **_against_truth(found, unit, case, setting), "seconds": seconds, "peak_memory_mib": _peak()}


def answer_fields(found: Answer, recordings: Sequence[Recording], library: Sequence[type[Effect]]) -> dict[str, Any]:
    """The answer as plain values, without the truth."""
    decision = found.decision
    return {
        "recordings": len(recordings),
        "verdict": found.verdict,
        "sentence": sentence(found, found_effects(found)),
        "probability": decision.probability,
        "accepted": _names(decision.effects),
        "alternatives": [
            {"effects": _names(option.effects), "unknown": option.unknown, "probability": probability}
            for option, probability in decision.credible
        ],
        "nearest": _names(found.nearest[0].effects) if found.nearest else [],
        "lines": [line.effect.name() for line in found.lines],
        "found": text.entries(found.effects),
        "unknown": [[each.atom.order, each.atom.pattern, each.atom.law] for each in found.unknown],
        "absorbed": [score.hypothesis.kind.name() for score in found.absorbed],
        "seen_from": {score.hypothesis.kind.name(): number(score.detectable) for score in decision.scores},
        "scores": [[s.hypothesis.kind.name(), s.gain, s.chance] for s in decision.scores[:6]],
        "smallest_chance": min((s.chance for s in decision.scores), default=1.0),
        "baselines": named_by_baselines(decision.before, library),
    }


def _against_truth(found: Answer, unit: Unit, case: Sealed, setting: Setting) -> dict[str, Any]:
    """Errors at unseen points, log-likelihoods of the models, and the true values next to the reported intervals."""
    before, after = found.decision.before, found.decision.after
    truth = unseen(case, setting, before.measured.layout)
    models = {"before": before, "after": after, "oracle": _oracle(before, unit, case)}
    sizes, angles = _intervals(found, case)
    return {
        "error": {name: unseen_error(fitted, truth) for name, fitted in models.items()},
        "log_likelihood": {name: fitted.log_likelihood for name, fitted in models.items()},
        "heldout": heldout(before, after),
        "intervals": sizes,
        "angles": angles,
    }


def _oracle(before: Fitted, unit: Unit, case: Sealed) -> Fitted:
    """The fit with the hidden effects, whose sizes are fitted."""
    known = [effect for effect in case.effects if not is_random(type(effect))]
    if not known:
        return before
    return fit(before.measured, unit, unit.model.plus(*known))


def _intervals(answer_: Answer, case: Sealed) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """True value, estimate and reported standard deviation: of sizes of correctly named effects, and of phases and
    positions if all choices, such as the order, are correct too.
    """
    sizes, angles, after = [], [], answer_.decision.after
    for true in case.effects:
        alike = _found_as(true, after.added)
        if alike is None:
            continue
        number = len(after.unit.model.effects) + alike
        effect = after.model.effects[number]
        for name, q in quantities(type(true)).items():
            deviation = answer_.decision.deviation.get(name_of(effect, number, name), np.nan)
            found = {"name": true.name(), "found": float(getattr(effect, name)), "deviation": float(deviation)}
            if q.role is Role.SIZE:
                sizes.append(found | {"true": float(_acted(true, case, after, number))})
            elif q.role in (Role.PHASE, Role.ANGLE) and kind_of(effect) == kind_of(true):
                angles.append(found | {"true": float(getattr(true, name))})
    return sizes, angles


def _found_as(true: Effect, effects: Sequence[Effect]) -> int | None:
    """Number of the found effect of the same class as a hidden one, preferably with the same choices.

    A second effect of that class, such as another order, counts as a false effect.
    """
    alike = [number for number, effect in enumerate(effects) if type(effect) is type(true)]
    return next(
        (number for number in alike if kind_of(effects[number]) == kind_of(true)),
        alike[0] if alike else None,
    )


def _acted(true: Effect, case: Sealed, after: Fitted, number: int) -> float:
    """The size of a hidden effect in the recordings. If it differs between operating points: the mean, weighted by the
    squared signature over the variance of the noise.
    """
    name, measured = size_of(type(true)), after.measured
    if case.alteration is None:
        return getattr(true, name)
    sizes = np.array([getattr(resized(true, case.alteration.factor(s.point)), name) for s in measured.situations])
    seen = (signature(after, number) ** 2 / after.errors.variance).reshape(measured.values.shape).sum(axis=1)
    return float(np.average(sizes[measured.of_recording], weights=seen))


def _names(effects: Sequence[Effect]) -> list[str]:
    return [effect.name() for effect in effects]


def _peak() -> float:
    """Largest memory of this process so far [MiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
