"""The accepted effects with their evidence and rivals, and the effects that were fitted but not accepted."""

from collections.abc import Mapping
from typing import Any

from swgsim.common.numbers import estimate, number, probability
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.effects.text import path_of
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.decide.accepted import Step, chosen
from swgsim.identification.decide.candidate import LEAST_EVIDENCE, LIKELIER, Trial
from swgsim.identification.fit.errors import Errors
from swgsim.identification.fit.form_error import LEAST_GAIN, NO_SIZE
from swgsim.identification.fit.priors import name_of
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.prediction_errors import overall


def names(trial: Trial) -> str:
    """The registered names of the effects of a trial."""
    return " and ".join(path_of(type(effect)) for effect in trial.effects)


def found_effects(answer: Answer) -> list[dict[str, Any]]:
    """All found effects as in ``report.json``."""
    return [*accepted(answer), *(of_line(line) for line in answer.lines)]


def accepted(answer: Answer) -> list[dict[str, Any]]:
    """The accepted effects with their evidence and their rivals."""
    after, found = answer.closed.after, []
    at = len(answer.closed.before.model.effects)
    for step in answer.closed.steps:
        for which in range(len(step.accepted.effects)):
            effect = after.model.effects[at]
            # A rival pair that contains this effect too is a rival of the other effect of the pair.
            rivals = [r for r in step.rivals if chosen(step.accepted.effects[which]) not in map(chosen, r.effects)]
            found.append({
                "name": path_of(type(effect)),
                "place": effect.place,
                "parameters": _parameters(effect, answer.closed.deviation, at),
                "evidence": _evidence(step, which),
                "indistinguishable_from": [names(rival) for rival in rivals],
                "rivals": [_rival(rival) for rival in rivals],
            })  # fmt: skip
            at += 1
    return found


def of_line(line: Sideline) -> dict[str, Any]:
    """An effect that makes interharmonic lines, with a random phase in every recording."""
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
                f"its interharmonic lines are significant (p-value {probability(line.chance)}); its law over load and "
                f"speed agrees with all recordings (p-value {line.agrees:.2g})"
            ),
            "score": number(line.gain),
            "chance": number(line.chance),
            "coherence": {"chance": number(line.agrees), "form_error": None},
        },
        "indistinguishable_from": [],
        "rivals": [],
    }


def rejected(answer: Answer) -> list[dict[str, Any]]:
    """Effects that were fitted but not accepted."""
    steps = answer.closed.steps
    # An effect that was rejected in one step may be accepted, or be a rival, in a later one.
    held = {path_of(type(e)) for step in steps for trial in (step.accepted, *step.rivals) for e in trial.effects}

    def accepted_later(trial: Trial) -> bool:
        return held.issuperset(path_of(type(effect)) for effect in trial.effects)

    tried: dict[str, tuple[Trial, Trial | None]] = {
        names(trial): (trial, step.accepted) for step in steps for trial in step.others if not accepted_later(trial)
    }
    rejected_last = (*answer.closed.rejected, *(t for t in answer.closed.withdrawn if not accepted_later(t)))
    # Of two trials of the same effects, the first one is better.
    tried |= {names(trial): (trial, None) for trial in reversed(rejected_last)}
    return [
        {
            "name": name,
            "heldout_error": _heldout(trial),
            "why": why(trial, answer, better),
        }
        for name, (trial, better) in tried.items()
    ]


def _heldout(trial: Trial) -> float | None:
    """Error at left-out operating points of a model with the effects of a trial."""
    fitted = trial.fitted.strict
    return overall(fitted.measured, Errors(fitted, fitted).heldout)


def why(trial: Trial, answer: Answer, better: Trial | None = None) -> str:
    """Why a trial was not accepted, in words."""
    outdone_by = answer.closed.outdone_by
    if better is None and outdone_by and trial is answer.closed.best_rejected:
        return (
            f"a regularity explains the same lines better, or explains much more: {outdone_by} (reduction of the sum "
            f"of squares {outdone_by.gain:.0f} against {trial.explained(answer.closed.asked):.0f})"
        )
    if trial in answer.closed.cancelling:
        which = "its effects" if len(trial.effects) > 1 else "it and another effect"
        return f"{which} largely cancel each other: together they imitate another cause"
    if trial in answer.closed.outweighed:
        return "it gains less than ten times the unexplained remainder: it is probably a part of another cause"
    if trial in answer.closed.withdrawn:
        return "accepted at first; with all others in the model, another effect or no effect is significant instead"
    if not trial.fitted.calibrated.settled:
        return "its fit did not converge"
    split, effect = max(zip(trial.coherence, trial.effects, strict=True), key=lambda each: each[0].disagreement)
    if split.disagreement >= NO_SIZE:
        size = f"the size of {effect.title()}" if len(trial.effects) > 1 else "its size"
        return (
            f"operating points, channels and orders disagree: {size} is uncertain by {100 * split.disagreement:.0f} %"
        )
    poorest = min(trial.coherence, key=lambda each: each.chance)
    if not poorest.holds:
        form = f"; its form deviates by {100 * poorest.form_error:.0f} %" if poorest.form_error else ""
        return (
            "no single size fits all operating points, channels and orders "
            f"(p-value {probability(poorest.chance)}{form})"
        )
    if trial.disowned:
        share = 100 * trial.own / as_squares(trial.evidence)
        return (
            f"its library form explains {share:.0f} % of its gain; the remainder comes from nuisance parameters for "
            "this gear's other structure, which could fit other causes as well"
        )
    if not trial.pays:
        return (
            "it does not improve the prediction of left-out operating points, or hardly raises the likelihood of all "
            f"recordings: log-likelihood {trial.heldout_gain:+.1f} and {trial.evidence:+.1f}; required are "
            f"{LEAST_GAIN:g} and {LIKELIER:g}, or {LEAST_EVIDENCE:g} for all recordings"
        )
    if better is None and trial is answer.closed.best_rejected and answer.closed.apart:
        return "it may be part of a disturbance of one channel, or leaves a larger remainder in that channel"
    if better is None:
        return "another effect explains more but was not accepted; a runner-up is never accepted instead"
    return (
        f"it explains less than {' and '.join(e.title() for e in better.effects)}: log-likelihood of left-out "
        f"operating points {trial.heldout_gain:+.0f} against {better.heldout_gain:+.0f}, of all recordings "
        f"{trial.evidence:+.0f} against {better.evidence:+.0f}"
    )


def _parameters(effect: Effect, deviation: Mapping[str, float], number_: int) -> dict[str, dict[str, Any]]:
    """Parameters of the effect with that number in its model; chosen or fixed parameters have no interval."""
    found = {}
    for name, q in quantities(type(effect)).items():
        value = getattr(effect, name)
        spread = deviation.get(name_of(effect, number_, name))
        if spread is None:
            found[name] = {"value": number(value), "ci95": None, "unit": q.unit}
        elif q.role in (Role.PHASE, Role.ANGLE):
            found[name] = estimate(value, spread, q.unit)
        else:
            found[name] = estimate(value, spread, q.unit, q.low, q.high)
    return found


def _rival(trial: Trial) -> dict[str, Any]:
    """A rival explanation at its most probable parameters."""
    first = len(trial.fitted.model.effects) - len(trial.effects)
    return {
        "effects": [
            {"name": path_of(type(e)), "parameters": _parameters(e, trial.deviation, first + i)}
            for i, e in enumerate(trial.effects)
        ],
        "heldout_gain": number(trial.heldout_gain),
        "beside": [str(each) for each in trial.beside],
    }  # fmt: skip


def _evidence(step: Step, which: int) -> dict[str, Any]:
    """The evidence for an effect, in words and numbers."""
    trial, score = step.accepted, step.accepted.score
    agreement = trial.coherence[which]
    together = " (together with the other effect of the pair)" if len(trial.effects) > 1 else ""
    raised = (
        f"left-out operating points by {trial.heldout_gain:.0f} and that of all recordings by {trial.evidence:.0f} "
        f"(required: {LEAST_GAIN:g} and {LIKELIER:g})"
        if trial.heldout_gain > LEAST_GAIN
        else f"all recordings by {trial.evidence:.0f} (required: {LEAST_EVIDENCE:g}; all operating points show the "
        "effect alike, so left-out points give no additional evidence)"
    )
    unrelated = "; ".join(map(str, trial.beside))
    without = f", after unrelated regularities were removed: {unrelated}" if unrelated else ""
    if trial.imperfect:
        test = (
            f"nuisance parameters of the gear absorb all but {100 * score.visible:.2g} % of its library form; the "
            f"recordings show it by a deviation of {100 * agreement.form_error:.0f} % from that form, which explains "
            "the whole lack of fit and is more probable than regularities"
        )
    else:
        test = (
            f"the p-value of its score in the whole library is {probability(score.chance)}; one size fits all "
            f"operating points, channels and orders; its parts differ by {100 * agreement.form_error:.0f} %{without}"
        )
    return {
        "words": f"adding it{together} raises the log-likelihood of {raised}; {test}",
        "heldout_gain": number(trial.heldout_gain),
        "evidence": number(trial.evidence),
        "score": number(score.gain),
        "chance": number(score.chance),
        "visible": number(score.visible),
        "coherence": {"chance": number(agreement.chance), "form_error": number(agreement.form_error)},
    }
