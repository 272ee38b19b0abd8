"""The effects that were found with their probabilities, and the options that were compared."""

from collections.abc import Mapping
from math import exp, log
from typing import Any

from swgsim.common.numbers import estimate, number, probability
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.effects.text import path_of
from swgsim.identification.decide.option import Option
from swgsim.identification.fit.priors import name_of
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.effect_words import effect_in_words, names_in_words

# Options that the report shows at most.
MOST_SHOWN = 12


def found_effects(answer: Answer) -> list[dict[str, Any]]:
    """All found effects as in ``report.json``."""
    return [*_of_orders(answer), *(of_line(line) for line in answer.lines)]


def _of_orders(answer: Answer) -> list[dict[str, Any]]:
    """The effects that were found in the order lines."""
    decision = answer.decision
    first = len(decision.before.model.effects)
    with_p_values = {score.hypothesis.kind: score for score in decision.scores}
    found = []
    for at, effect in enumerate(decision.effects, first):
        if effect in answer.small:
            continue
        known, score = decision.probability_of(effect), with_p_values.get(type(effect))
        found.append({
            "name": path_of(type(effect)),
            "place": effect.place,
            "parameters": _parameters(effect, decision.deviation, at),
            "probability": number(known),
            "evidence": {
                "words": _evidence(answer, effect, known),
                "gain": number(decision.gain_of(effect)),
                "score": number(score.gain) if score else None,
                "chance": number(score.chance) if score else None,
                "form_error": number(decision.best.form_error),
            },
        })  # fmt: skip
    return found


def _evidence(answer: Answer, effect: Effect, known: float) -> str:
    best, gain = answer.decision.best, answer.decision.gain_of(effect)
    return (
        f"the probability that it is missing is {probability_text(known)}; with it the recordings are more probable by "
        f"a factor of {_factor(gain)}, all other parameters being integrated over their priors; its lines differ from "
        f"the library form by {100 * best.form_error:.0f} %"
    )


def _factor(log_ratio: float) -> str:
    """A ratio of probabilities in words; report.json has its logarithm.

    >>> _factor(3.0), _factor(3201.0)
    ('20', 'more than a million')
    """
    return f"{exp(log_ratio):,.0f}" if log_ratio < log(1e6) else "more than a million"


def probability_text(value: float) -> str:
    """A probability for a text.

    >>> probability_text(0.97), probability_text(0.99998), probability_text(0.001)
    ('0.97', 'above 0.999', 'below 0.01')
    """
    if value > 0.999:
        return "above 0.999"
    return "below 0.01" if value < 0.01 else f"{value:.3f}" if value > 0.99 else f"{value:.2f}"


def of_line(line: Sideline) -> dict[str, Any]:
    """An effect that makes interharmonic lines, with a random phase in every recording."""
    effect = line.effect
    size = name_of(effect, 0, size_of(type(effect)))
    return {
        "name": path_of(type(effect)),
        "place": effect.place,
        "parameters": _parameters(effect, {size: line.deviation}, 0),
        "evidence": {
            "words": (
                f"its interharmonic lines are significant (p-value {probability(line.chance)}); its law over load and "
                f"speed agrees with all recordings (p-value {line.agrees:.2g})"
            ),
            "score": number(line.gain),
            "chance": number(line.chance),
            "agrees": number(line.agrees),
        },
        "probability": None,
    }


def options(answer: Answer) -> list[dict[str, Any]]:
    """The most probable options: sets of effects and regularities, with their probabilities."""
    decision = answer.decision
    best = decision.weighed[0][0].log_posterior
    return [
        {
            "words": in_words(option),
            "effects": [path_of(type(effect)) for effect in option.effects],
            "regularities": [str(each) for each in option.regularities],
            "probability": number(p),
            "log_ratio": number(option.log_posterior - best),
        }
        for option, p in decision.weighed[:MOST_SHOWN]
    ]


def alternatives(answer: Answer) -> list[dict[str, Any]]:
    """The credible set: the fewest answers that have a probability of 95 % together, the most probable first."""
    return [
        {
            "words": in_words(option),
            "effects": [_at_fit(effect) for effect in option.effects],
            "unknown": option.unknown,
            "probability": number(p),
        }
        for option, p in answer.decision.credible
    ]


def small(answer: Answer) -> list[dict[str, Any]]:
    """What is probable but too small to matter, with its share of the spread of healthy units."""
    shares = zip(answer.added, answer.shares_of_spread, strict=True)
    return [{"words": effect_in_words(effect), "share": number(by)} for effect, by in shares if effect in answer.small]


def in_words(option: Option) -> str:
    """What an option says is missing."""
    words = [names_in_words(option.effects)] if option.effects else []
    words += ["something unknown"] if option.unknown else []
    return " and ".join(words) or "nothing"


def _at_fit(effect: Effect) -> dict[str, Any]:
    """An effect of another option at its most probable parameters."""
    return {"name": path_of(type(effect)), "parameters": _parameters(effect, {}, 0)}


def _parameters(effect: Effect, deviation: Mapping[str, float], number_: int) -> dict[str, dict[str, Any]]:
    """Parameters of the effect with that number in its model; chosen or fixed parameters have no interval, and random
    ones are left out.
    """
    found = {}
    for name, q in quantities(type(effect)).items():
        if q.role is Role.RANDOM:
            continue
        value = getattr(effect, name)
        spread = deviation.get(name_of(effect, number_, name))
        if spread is None:
            found[name] = {"value": number(value), "ci95": None, "unit": q.unit}
        elif q.role in (Role.PHASE, Role.ANGLE):
            found[name] = estimate(value, spread, q.unit)
        else:
            found[name] = estimate(value, spread, q.unit, q.low, q.high)
    return found
