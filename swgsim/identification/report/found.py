"""The effects that were found, with their evidence and rivals, and those that were fitted and not accepted."""

from collections.abc import Mapping
from typing import Any

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.effects.text import path_of
from swgsim.identification.report.answer import Answer
from swgsim.identification.fit.priors import name_of
from swgsim.identification.fit.errors import Errors
from swgsim.identification.fit.form_error import LEAST_GAIN, NO_SIZE
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.common.numbers import estimate, number, probability
from swgsim.identification.report.prediction_errors import overall
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.decide.accepted import Step, chosen
from swgsim.identification.decide.candidate import LEAST_EVIDENCE, LIKELIER, Trial


def names(trial: Trial) -> str:
    """The effects of a trial by their registered names."""
    return " and ".join(path_of(type(effect)) for effect in trial.effects)


def accepted(answer: Answer) -> list[dict[str, Any]]:
    """The effects that were added, with their evidence and their rivals."""
    after, found = answer.closed.after, []
    at = len(answer.closed.before.model.effects)
    for step in answer.closed.steps:
        for which in range(len(step.accepted.effects)):
            effect = after.model.effects[at]
            # A rival of a pair that has this effect as well is another explanation of the other one.
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


def rejected(answer: Answer) -> list[dict[str, Any]]:
    """Effects that were fitted but not added."""
    steps = answer.closed.steps
    # What was put off in one step may be found, or be a rival, in a later one.
    held = {path_of(type(e)) for step in steps for trial in (step.accepted, *step.rivals) for e in trial.effects}

    def elsewhere(trial: Trial) -> bool:
        return held.issuperset(path_of(type(effect)) for effect in trial.effects)

    tried: dict[str, tuple[Trial, Trial | None]] = {
        names(trial): (trial, step.accepted) for step in steps for trial in step.others if not elsewhere(trial)
    }
    put_off = (*answer.closed.rejected, *(trial for trial in answer.closed.withdrawn if not elsewhere(trial)))
    # Of two of a kind the first one is told, which came nearer.
    tried |= {names(trial): (trial, None) for trial in reversed(put_off)}
    return [
        {
            "name": name,
            "heldout_error": _heldout(trial),
            "why": why(trial, answer, better),
        }
        for name, (trial, better) in tried.items()
    ]


def _heldout(trial: Trial) -> float | None:
    """Error of operating points left out by a model with what was tried."""
    fitted = trial.fitted.strict
    return overall(fitted.measured, Errors(fitted, fitted).heldout)


def why(trial: Trial, answer: Answer, better: Trial | None = None) -> str:
    """Why a trial was not accepted, in words."""
    outdone_by = answer.closed.outdone_by
    if better is None and outdone_by and trial is answer.closed.best_rejected:
        return (
            f"a bare regularity explains the same thing better, or far more beside it: {outdone_by} (fall of the sum "
            f"of squares {outdone_by.gain:.0f} against {trial.explained(answer.closed.asked):.0f})"
        )
    if trial in answer.closed.cancelling:
        which = "its effects" if len(trial.effects) > 1 else "it and another one"
        return f"{which} cancel much of one another: together they imitate something else"
    if trial in answer.closed.outweighed:
        return "it brings less than ten times what it leaves, which no effect explains: a part of something else"
    if trial in answer.closed.withdrawn:
        return "accepted at first; once the others were in the model, another one, or nothing, stood in its place"
    if not trial.fitted.calibrated.settled:
        return "its fit did not come to rest"
    split, effect = max(zip(trial.coherence, trial.effects, strict=True), key=lambda each: each[0].disagreement)
    if split.disagreement >= NO_SIZE:
        size = f"the size of {effect.title()}" if len(trial.effects) > 1 else "its size"
        return f"operating points, channels and orders leave {size} in doubt by {100 * split.disagreement:.0f} %"
    poorest = min(trial.coherence, key=lambda each: each.chance)
    if not poorest.holds:
        form = f"; its form differs by {100 * poorest.form_error:.0f} %" if poorest.form_error else ""
        return (
            "one size does not serve all operating points, channels and orders "
            f"(probability {probability(poorest.chance)}{form})"
        )
    if trial.disowned:
        share = 100 * trial.own / as_squares(trial.evidence)
        return (
            f"as the library has it, it explains {share:.0f} % of what it gains; the rest is explained by what is left "
            "open for this gear's other structure, which fits much else as well"
        )
    if not trial.pays:
        return (
            "it does not help to predict operating points left out, or the whole is hardly likelier with it: "
            f"log-likelihood {trial.heldout_gain:+.1f} and {trial.evidence:+.1f}, at least {LEAST_GAIN:g} and "
            f"{LIKELIER:g} are asked for, or {LEAST_EVIDENCE:g} of the whole"
        )
    if better is None and trial is answer.closed.best_rejected and answer.closed.apart:
        return "it may be part of a disturbance that was set apart, or leaves more of that channel without a name"
    if better is None:
        return "another effect explains more, which was not accepted, and the runner-up is never taken instead"
    return (
        f"it explains less than {' and '.join(e.title() for e in better.effects)}: log-likelihood of operating points "
        f"left out {trial.heldout_gain:+.0f} against {better.heldout_gain:+.0f}, of all recordings "
        f"{trial.evidence:+.0f} against {better.evidence:+.0f}"
    )


def _parameters(effect: Effect, deviation: Mapping[str, float], number_: int) -> dict[str, dict[str, Any]]:
    """Parameters of the effect with that number in its model; those that were chosen or fixed have no interval."""
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
    """Another explanation that these recordings cannot rule out, at its likeliest parameters."""
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
    """Why an effect is believed."""
    trial, score = step.accepted, step.accepted.score
    agreement = trial.coherence[which]
    together = " (together with the other effect of the pair)" if len(trial.effects) > 1 else ""
    raised = (
        f"operating points left out by {trial.heldout_gain:.0f} and that of all together by {trial.evidence:.0f} (at "
        f"least {LEAST_GAIN:g} and {LIKELIER:g} are asked for)"
        if trial.heldout_gain > LEAST_GAIN
        else f"all recordings together by {trial.evidence:.0f} (at least {LEAST_EVIDENCE:g} are asked for; every "
        "operating point shows it alike, so those left out do not tell)"
    )
    beside = "; ".join(map(str, trial.beside))
    once = f", once what has nothing to do with it is taken out: {beside}" if beside else ""
    if trial.imperfect:
        why_believed = (
            f"in the library's own form, what is open of the gear absorbs all but {100 * score.visible:.2g} % of it; "
            f"it shows by how it differs from that form, by {100 * agreement.form_error:.0f} %, which tells all that "
            "is missing and is likelier than bare regularities"
        )
    else:
        why_believed = (
            f"so high a score comes by luck with probability {probability(score.chance)} in the whole library; one "
            "size serves all operating points, channels and orders, with parts that differ by "
            f"{100 * agreement.form_error:.0f} %{once}"
        )
    return {
        "words": f"adding it{together} raises the log-likelihood of {raised}; {why_believed}",
        "heldout_gain": number(trial.heldout_gain),
        "evidence": number(trial.evidence),
        "score": number(score.gain),
        "chance": number(score.chance),
        "visible": number(score.visible),
        "coherence": {"chance": number(agreement.chance), "form_error": number(agreement.form_error)},
    }
