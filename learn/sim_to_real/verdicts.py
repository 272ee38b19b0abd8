"""Whether closing the loop helped a classifier, and if not, why."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from swgsim.common.style import words

RECOVERED = 0.8  # share of the oracle's gain that counts as full recovery
LEAST_ORACLE_GAIN = 1.0  # gain of the oracle [points] from which on an effect counts as one that costs accuracy


@dataclass(frozen=True, eq=False)
class Finished:
    """Results for one undeclared effect.

    Attributes
    ----------
    name : str
    hidden : list
        The effect as text.
    loop : mapping
        Answer of the loop: ``verdict``, ``sentence``, ``found`` (effects as text), ``rivals`` and ``absorbed``
        (names), ``error``.
    scores : DataFrame
        Of :func:`learn.sim_to_real.scores.scores`.
    """

    name: str
    hidden: list[dict[str, Any]]
    loop: Mapping[str, Any]
    scores: pd.DataFrame


def row_of(scores: pd.DataFrame, method: str, day: str, model: str) -> pd.Series:
    """The scores of a method with references of a day, trained on a model."""
    chosen = (scores["method"] == method) & (scores["day"] == day) & (scores["model"] == model)
    return scores[chosen].iloc[0]


def named(finished: Finished) -> str:
    """The loop's answer compared with the truth, in four words at most."""
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
            f"Regenerating with {brings}, but by {after['gain_low']:+.1f} to {after['gain_high']:+.1f} points: too few "
            "specimens to distinguish it from no gain."
        )
    return "does not help", (
        f"The effect found, {_listed(finished.loop['found'])}, changes this method's features in another way."
    )


def _unfound(finished: Finished) -> str:
    """The loop's answer if it named no effect."""
    if named(finished) == "cannot be tested":
        return (
            f"These recordings cannot test {_listed(finished.hidden)}: nuisance parameters of the model, such as the "
            "zeros of a session, explain it."
        )
    return str(finished.loop["sentence"])


def _safe(after: pd.Series) -> tuple[str, str]:
    """Verdict and reason for an effect that was found where none acts."""
    if after["gain_high"] < 0:
        return "harms", f"A false effect costs {-after['gain']:.1f} points."
    return "does no harm", f"A false effect was found; it changes the accuracy by {after['gain']:+.1f} points."


def worth(oracle: pd.Series) -> bool:
    """Whether a model with the true effect is significantly more accurate, by at least :data:`LEAST_ORACLE_GAIN`."""
    return bool(oracle["gain_low"] > 0 and oracle["gain"] >= LEAST_ORACLE_GAIN)


def _unneeded(before: pd.Series, after: pd.Series, oracle: pd.Series) -> tuple[str, str]:
    """Verdict and reason where even the true effect gains nothing."""
    if after["gain_high"] < 0:
        return (
            "harms",
            f"Knowing the effect gains nothing here, and the effect found costs {-after['gain']:.1f} points.",
        )
    return "nothing to gain", (
        "Even a model that knows the effect is not significantly better by a point "
        f"({before['accuracy']:.1f} % without it, {oracle['accuracy']:.1f} % with it)."
    )


def _names(entries: Sequence[dict[str, Any]]) -> list[str]:
    return [name for entry in entries for name in entry]


def _listed(entries: Sequence[dict[str, Any]]) -> str:
    return " and ".join(words(name) for name in _names(entries)) or "nothing"
