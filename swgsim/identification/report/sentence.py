"""The verdict in one sentence, in engineering units."""

from collections.abc import Mapping, Sequence
from typing import Any

from swgsim.common.outcome import FOUND, NOTHING
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.effect_words import effect_in_words, effect_text
from swgsim.identification.report.found_effects import in_words, probability_text

# Untestable effects, and other answers, that the sentence names at most; the report has all of them.
MOST_NAMED = 6


def sentence(answer: Answer, effects: Sequence[Mapping[str, Any]]) -> str:
    """The verdict in one sentence.

    Parameters
    ----------
    answer : Answer
    effects : sequence of mapping
        The found effects as in ``report.json``.
    """
    if answer.verdict == NOTHING:
        return (
            f"Nothing is missing: the model explains the recordings down to their noise{_if_balanced(answer)}"
            f"{_sure(answer)}{_small(answer)}{_untestable(answer)}."
        )
    if answer.verdict == FOUND:
        found = "; and ".join(effect_text(each["name"], each["parameters"]) for each in effects)
        remainder = f"; and an unknown remainder: {answer.unexplained}" if answer.unexplained else ""
        return f"The model lacks {found}{remainder}{_sure(answer)}."
    return f"The model lacks something that is not in the library: {answer.unexplained}{_sure(answer)}."


def _small(answer: Answer) -> str:
    words = ", ".join(map(effect_in_words, answer.small))
    return f"; seen, but too small to matter: {words}" if words else ""


def _sure(answer: Answer) -> str:
    """Probability of the answer of the order lines, and the other answers of the credible set."""
    decision = answer.decision
    if not answer.of_orders and not answer.unknown_of_orders and (answer.verdict != NOTHING or answer.small):
        return ""  # interharmonic lines or high orders alone, which have p-values
    others = [f"{in_words(option)} ({probability_text(p)})" for option, p in decision.credible[1:]]
    otherwise = f"; else {_listed(others, ', ')}" if others else ""
    return f": probability {probability_text(decision.probability)}{otherwise}"


def _if_balanced(answer: Answer) -> str:
    """The condition of the verdict, if zeros of gauges lie further off than declared."""
    zeros = answer.decision.after.measured.zeros
    if zeros == 1:
        return ""
    return (
        f", if the bridges were balanced again since commissioning (the zeros of the gauges lie up to {zeros:g} times "
        "as far off as between two sessions; an effect that shifts zeros would look the same)"
    )


def _untestable(answer: Answer) -> str:
    names = [score.hypothesis.kind.title() for score in answer.absorbed]
    return f"; these recordings cannot test {_listed(names, ', ')}" if names else ""


def _listed(names: Sequence[str], separator: str) -> str:
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return separator.join(names[:MOST_NAMED]) + more
