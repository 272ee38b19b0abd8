"""Whether closing the loop helped a classifier, and if not, why."""

from collections.abc import Sequence
from typing import Any

import pandas as pd

from learn.sim_to_real.finished import Finished
from swgsim.common.style import words

# Share of the oracle's gain that counts as all of it.
RECOVERED = 0.8
# Gain of the oracle from which an effect counts as one that costs accuracy [points].
WORTH = 1.0


def row_of(scores: pd.DataFrame, method: str, day: str, model: str) -> pd.Series:
    """The scores of a method with references of a day, trained on a model."""
    chosen = (scores["method"] == method) & (scores["day"] == day) & (scores["model"] == model)
    return scores[chosen].iloc[0]


def named(finished: Finished) -> str:
    """How the loop's answer stands to the truth: in four words at most."""
    true, found = _names(finished.hidden), _names(finished.loop["found"])
    rest = [name for name in found if name not in true]
    if not true:
        return "false effect" if found else "nothing, rightly"
    if not found and set(true) <= set(finished.loop["absorbed"]):
        return "cannot be tested"
    if not found:
        return "missed" if finished.loop["verdict"] == "nothing_missing" else "unknown effect"
    if all(name in found for name in true):
        return "right, and one more" if rest else "right"
    return "right among its rivals" if set(true) & set(finished.loop["rivals"]) else "another effect"


def why(finished: Finished, method: str, day: str) -> tuple[str, str]:
    """A verdict on one method with references of one day, and its reason in a sentence."""
    before, after, oracle = (row_of(finished.scores, method, day, model) for model in ("before", "after", "oracle"))
    if not finished.hidden:
        if not finished.loop["found"]:
            return "nothing to do", "Nothing acts, and nothing was found: the model stays as it is."
        return _safe(after)
    if not worth(oracle):
        return _unneeded(before, after, oracle)
    if not finished.loop["found"]:
        return "does not help", f"The loop found no effect to add. {_unfound(finished)}"
    share = after["gain"] / oracle["gain"]
    brings = f"{_listed(finished.loop['found'])} brings {share:.0%} of what knowing the effect brings"
    if after["gain_low"] > 0:
        return ("helps" if share >= RECOVERED else "helps in part"), f"Regenerating with {brings}."
    if share >= RECOVERED:
        return "does not clearly help", (
            f"Regenerating with {brings}, but by {after['gain_low']:+.1f} to {after['gain_high']:+.1f} points: the "
            "specimens are too few to tell it from nothing."
        )
    return "does not help", (
        f"What was found, {_listed(finished.loop['found'])}, does not act on this method's features as the truth does."
    )


def _unfound(finished: Finished) -> str:
    """What the loop said where it did not name an effect."""
    if named(finished) == "cannot be tested":
        return (
            f"It says that these recordings cannot test {_listed(finished.hidden)}: what the model declares not to "
            "know, such as the zeros of a session, looks the same."
        )
    return str(finished.loop["sentence"])


def _safe(after: pd.Series) -> tuple[str, str]:
    """Of an effect that was found where none acts."""
    if after["gain_high"] < 0:
        return "harms", f"A false effect costs {-after['gain']:.1f} points."
    return "does no harm", f"A false effect was found; it changes the accuracy by {after['gain']:+.1f} points."


def worth(oracle: pd.Series) -> bool:
    """Whether knowing the true effect brings accuracy back, beyond doubt and by more than a trifle."""
    return bool(oracle["gain_low"] > 0 and oracle["gain"] >= WORTH)


def _unneeded(before: pd.Series, after: pd.Series, oracle: pd.Series) -> tuple[str, str]:
    """Where even the true effect brings nothing."""
    if after["gain_high"] < 0:
        return "harms", f"Knowing the effect brings nothing here, and what was found costs {-after['gain']:.1f} points."
    return "nothing to gain", (
        "Even a model that knows the effect does no better by a point beyond doubt "
        f"({before['accuracy']:.1f} % without it, {oracle['accuracy']:.1f} % with it)."
    )


def _names(entries: Sequence[dict[str, Any]]) -> list[str]:
    return [name for entry in entries for name in entry]


def _listed(entries: Sequence[dict[str, Any]]) -> str:
    return " and ".join(words(name) for name in _names(entries)) or "nothing"
