"""Calibration: whether answers are right as often as their probabilities say."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float, Int
from scipy.stats import poisson

from swgsim.blind.intervals import rate
from swgsim.blind.scored_case import ScoredCase
from swgsim.blind.strata import OUTSIDE_STRATA, UNTESTABLE
from swgsim.identification.decide.prior import HEALTHY, OUTSIDE_LIBRARY

# Edges of the bins of probabilities.
BINS = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)


def reliability(cases: Sequence[ScoredCase]) -> list[dict[str, Any]]:
    """Mean probability and share of right answers, by bins of the probability."""
    stated, right, bins = _answers(cases)
    return [
        {"stated": float(stated[bins == each].mean()), "right": rate(right[bins == each].tolist())}
        for each in np.unique(bins)
    ]


def calibration_error(cases: Sequence[ScoredCase], weights: Float[np.ndarray, " case"] | None = None) -> float | None:
    """Expected calibration error: mean distance of probability and share of right answers, over all answers.

    Parameters
    ----------
    cases : sequence of ScoredCase
        Answered ones.
    weights : array (case,), optional
        By default all count alike.
    """
    if not cases:
        return None
    stated, right, bins = _answers(cases)
    if weights is None:
        weights = np.ones(len(cases))
    off = [abs(float((weights * (stated - right))[bins == each].sum())) for each in np.unique(bins)]
    return float(sum(off) / weights.sum())


def as_in_prior(cases: Sequence[ScoredCase]) -> Float[np.ndarray, " case"]:
    """Weights by which healthy gears, single effects, pairs and causes outside the library are as frequent as in the
    prior of the decision, which a set is not (importance sampling).

    A probability can only be right on average over gears for which its prior holds.
    """
    kinds = [_hidden(case) for case in cases]
    chance = poisson(-np.log(HEALTHY)).pmf([causes for causes, _ in kinds])
    known = [OUTSIDE_LIBRARY if outside else (1 - OUTSIDE_LIBRARY) ** causes for causes, outside in kinds]
    return np.array(chance * known / [kinds.count(each) for each in kinds])


def _hidden(case: ScoredCase) -> tuple[int, bool]:
    """Number of hidden causes, untestable ones being none, and whether they are outside the library."""
    nothing = case.null or case.case.stratum == UNTESTABLE
    return 0 if nothing else len(case.case.effects), case.case.stratum in OUTSIDE_STRATA


def _answers(
    cases: Sequence[ScoredCase],
) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, " case"], Int[np.ndarray, " case"]]:
    """Probability of every answer, whether it is right, and the number of its bin."""
    stated = np.array([case.answer["probability"] for case in cases])
    right = np.array([case.right for case in cases], float)
    return stated, right, np.clip(np.searchsorted(BINS, stated, side="right") - 1, 0, len(BINS) - 2)
