"""The verdict in one sentence, in engineering units."""

from collections.abc import Mapping, Sequence
from typing import Any

from swgsim.common.outcome import FOUND, NOTHING
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.effect_words import effect_in_words, effect_name, effect_text

# Untestable effects, and rivals of an effect, that the sentence names at most; the report has all of them.
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
            f"Nothing is missing: the model explains the recordings down to their noise{_if_balanced(answer)}, and no "
            f"effect of the library is significant{_untestable(answer)}."
        )
    nearest = _nearest(answer)
    if answer.verdict == FOUND:
        remainder = f"; an unknown remainder: {answer.unexplained}{nearest}" if answer.unexplained else ""
        return f"The model lacks {'; and '.join(map(_explanation, effects))}{remainder}."
    return f"The model lacks something that is not in the library: {answer.unexplained}{nearest}."


def _explanation(effect: Mapping[str, Any]) -> str:
    """A found effect, and the rivals from which these recordings cannot separate it."""
    rivals = [
        " with ".join(effect_name(each["name"], each["parameters"]) for each in rival["effects"])
        for rival in effect["rivals"]
    ]
    text = effect_text(effect["name"], effect["parameters"])
    return text + (f" (these recordings cannot separate it from {_listed(rivals, ' or ')})" if rivals else "")


def _if_balanced(answer: Answer) -> str:
    """The condition of the verdict, if zeros of gauges lie further off than declared."""
    zeros = answer.closed.after.measured.zeros
    if zeros == 1:
        return ""
    return (
        f", if the bridges were balanced again since commissioning (the zeros of the gauges lie up to {zeros:g} times "
        "as far off as between two sessions; an effect that shifts zeros would look the same)"
    )


def _untestable(answer: Answer) -> str:
    names = [score.hypothesis.kind.title() for score in answer.absorbed]
    return f"; these recordings cannot test {_listed(names, ', ')}" if names else ""


def _nearest(answer: Answer) -> str:
    if answer.nearest is None:
        return ""
    known, share = " with ".join(map(effect_in_words, answer.nearest.effects)), 100 * answer.closed.nearest_explains
    return f"; the nearest known effect ({known}) explains {share:.0f} % of the remainder and was not accepted"


def _listed(names: Sequence[str], separator: str) -> str:
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return separator.join(names[:MOST_NAMED]) + more
