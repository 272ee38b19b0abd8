"""Score test of every hypothesis, with nuisance parameters marginalised.

No hypothesis is fitted here. The residual at the fitted parameters is compared with the signature of every effect. Both
are weighted by the covariance of noise and nuisance parameters.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from swgsim.common.chi2_logsf import log_tail, surprise
from swgsim.common.singular import svd
from swgsim.effects.quantity import Quantity, quantities
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import Hypothesis

# Visible share of a signature below which it is rounding of the chain and of its differences. It is no measure of
# detectability: the share is small wherever the noise is small relative to the prior of a nuisance parameter.
LEAST_VISIBLE_SHARE = 1e-8
# Directions of a signature below this part of its largest one are rounding.
LEAST_DIRECTION = 1e-6
# Largest number of draws of noise, draws at a time, and number of higher scores at which drawing ends, because the best
# score is then not significant (Besag and Clifford, Biometrika 78 (1991) 301).
DRAWS, AT_ONCE, ENOUGH = 1000, 100, 20
# A logarithm of a probability this many times that of the most unlikely draw is far beyond them.
FAR = 2.0
# Probability of a false effect on recordings in which nothing is missing.
ALPHA = 0.005
# Standard deviations of a size at its detection limit: 4.31 for the p-value :data:`ALPHA` among the 300
# hypotheses of the library, and 0.84 for a power of 80 %.
DEVIATIONS_AT_LIMIT = 5.15


@dataclass(frozen=True)
class Score:
    """Score of one hypothesis.

    Attributes
    ----------
    hypothesis : Hypothesis
    gain : float
        Reduction of the residual's sum of squares by the effect, in units of the noise.
    freedom : int
        Degrees of freedom: 1, or 2 for a wave.
    estimate : float
        Expected size.
    phase : float
        Expected phase of a wave [rad].
    deviation : float
        Standard deviation of the size, declared parameters being open.
    visible : float
        Share of the signature that nuisance parameters do not absorb.
    chance : float
        Probability that the best score of the whole library is as high as this if nothing is missing.
    """

    hypothesis: Hypothesis
    gain: float
    freedom: int
    estimate: float
    phase: float
    deviation: float
    visible: float
    chance: float

    @property
    def rank(self) -> float:
        """Significance of the gain, for sorting: the higher, the less likely is the gain by chance.

        It is -2 ln(p) with the p-value p of the gain alone, less 2 ln of the number of hypotheses tried of the effect.
        """
        return surprise(self.gain, self.freedom) - as_squares(float(np.log(self.hypothesis.tried)))

    @property
    def detectable(self) -> float:
        """The detection limit: the smallest size that is significant with a probability of 80 %."""
        return DEVIATIONS_AT_LIMIT * self.deviation

    @property
    def value_at_limit(self) -> float:
        """The value of the parameter at the detection limit.

        A size is a distance from the value at which the effect changes nothing. It is taken in the direction of the
        typical value.
        """
        quantity = self._quantity
        return quantity.nothing + float(np.copysign(self.detectable, quantity.typical - quantity.nothing))

    @property
    def within_bounds(self) -> bool:
        """Whether the parameter may have its value at the detection limit."""
        return self._quantity.low <= self.value_at_limit <= self._quantity.high

    @property
    def size_of_signature(self) -> float:
        """The size of the effect for which its signature was computed: that of the hypothesis, typical at first."""
        return abs(self.hypothesis.typical - self._quantity.nothing)

    @property
    def absorbed(self) -> bool:
        """Whether no size within the bounds would be seen."""
        quantity = self._quantity
        largest = max(quantity.high - quantity.nothing, quantity.nothing - quantity.low)
        return self.visible < LEAST_VISIBLE_SHARE or self.detectable > largest

    @property
    def _quantity(self) -> Quantity:
        return quantities(self.hypothesis.kind)[self.hypothesis.size]


def screen(
    found: Sequence[Hypothesis],
    signatures: Sequence[Float[np.ndarray, "row _"]],
    fitted: Fitted,
    rng: np.random.Generator,
) -> list[Score]:
    """Scores of all hypotheses, the best rank first.

    Parameters
    ----------
    found : sequence of Hypothesis
    signatures : sequence of array (row, column)
        Change by the typical size.
    fitted : Fitted
        The model without the effects.
    rng : Generator
    """
    projected = _all_projected(signatures, fitted)
    directions = np.hstack([p.directions for p in projected])
    freedom = np.array([p.directions.shape[1] for p in projected])
    noise = (directions.T @ each for each in fitted.null(AT_ONCE, rng))
    return _ranked(found, projected, fitted, family_wise(directions.T @ fitted.weighed, freedom, noise))


def rank(found: Sequence[Hypothesis], signatures: Sequence[Float[np.ndarray, "row _"]], fitted: Fitted) -> list[Score]:
    """Scores of all hypotheses, the best :attr:`Score.rank` first, as of :func:`screen` but without p-values (nan).

    The draws of noise for p-values take most of the time.
    """
    return _ranked(found, _all_projected(signatures, fitted), fitted, np.full(len(found), np.nan))


def _ranked(
    found: Sequence[Hypothesis],
    projected: Sequence["Projected"],
    fitted: Fitted,
    chances: Float[np.ndarray, " hypothesis"],
) -> list[Score]:
    along = [p.directions.T @ fitted.weighed for p in projected]
    scores = [_score(*each) for each in zip(found, projected, along, chances, strict=True)]
    return sorted(scores, key=lambda score: (-score.rank, -score.visible))


def best_of_kind(scores: Sequence[Score]) -> list[Score]:
    """The best hypothesis of every effect, in the order of the scores."""
    best: dict[type, Score] = {}
    for score in scores:
        best.setdefault(score.hypothesis.kind, score)
    return list(best.values())


class Projected(NamedTuple):
    """What is left of a signature: directions, along each of which a weighed residual has a standard deviation of 1,
    their sizes, how columns make them, visible share.
    """

    directions: Float[np.ndarray, "row rank"]
    s: Float[np.ndarray, " rank"]
    Vt: Float[np.ndarray, "rank column"]
    visible: float


def _all_projected(signatures: Sequence[Float[np.ndarray, "row _"]], fitted: Fitted) -> list[Projected]:
    """All signatures, with nuisance parameters projected out."""
    if not signatures:
        return []
    stacked = np.hstack(list(signatures))
    ends = np.cumsum([s.shape[1] for s in signatures])[:-1]
    white, alone = (np.split(errors.whiten(stacked), ends, axis=1) for errors in (fitted.whole, fitted.errors))
    return [_projected(*each) for each in zip(signatures, white, alone, strict=True)]


def _projected(
    signature: Float[np.ndarray, "row column"],
    white: Float[np.ndarray, "row column"],
    alone: Float[np.ndarray, "row column"],
) -> Projected:
    """Directions of a signature, from it whitened by all errors and without declared ones; none if these absorb it."""
    _, s, Vt = svd(white)
    size = float((alone**2).sum())
    visible = float((s**2).sum()) / size if size > 0 else 0.0
    kept = s > LEAST_DIRECTION * np.sqrt(size) if visible > LEAST_VISIBLE_SHARE else np.zeros(len(s), bool)
    return Projected(signature @ (Vt[kept].T / s[kept]), s[kept], Vt[kept], visible)


def _score(hypothesis: Hypothesis, projected: Projected, u: Float[np.ndarray, " rank"], chance: float) -> Score:
    """Figures of one hypothesis from its projections."""
    if not len(u):
        return Score(hypothesis, 0.0, 0, np.nan, np.nan, np.inf, projected.visible, 1.0)
    quantity = quantities(hypothesis.kind)[hypothesis.size]
    span = hypothesis.typical - quantity.nothing
    weights = projected.Vt.T @ (u / projected.s)
    along = weights / max(float(np.linalg.norm(weights)), 1e-300)
    deviation = abs(span) * float(np.linalg.norm((projected.Vt @ along) / projected.s))
    size, phase = span * float(weights[0]), 0.0
    if hypothesis.phase:
        size, phase = span * float(np.hypot(*weights)), float(np.arctan2(weights[1], weights[0]) % (2 * np.pi))
    size = float(np.clip(quantity.nothing + size, quantity.low, quantity.high))
    if size == quantity.nothing:
        # The best size lies on the side that the effect cannot have, so no size of it explains anything.
        return Score(hypothesis, 0.0, len(u), size, phase, deviation, projected.visible, 1.0)
    return Score(hypothesis, float(u @ u), len(u), size, phase, deviation, projected.visible, chance)


def family_wise(
    along: Float[np.ndarray, " direction"],
    freedom: Int[np.ndarray, " hypothesis"],
    noise: Iterable[Float[np.ndarray, "direction draw"]],
) -> Float[np.ndarray, " hypothesis"]:
    """Of every hypothesis, how often pure noise gives any of them a score as unlikely.

    Hypotheses overlap, so their scores are taken of the same draws of noise. The errors of single recordings are known
    from few recordings only: each draw has them as large as these may be.

    Parameters
    ----------
    along : array (direction,)
        What the residual has along the directions of all hypotheses, one after the other.
    freedom : array (hypothesis,)
        How many directions each has.
    noise : iterable of array (direction, draw)
        What pure noise has along them, without end.
    """
    used = np.flatnonzero(freedom)
    chances = np.ones(len(freedom))
    if not len(used):
        return chances
    starts = np.concatenate([[0], np.cumsum(freedom[used])[:-1]])
    own = log_tail(np.add.reduceat(along**2, starts), freedom[used])
    lowest = np.zeros(0)
    for drawn in noise:
        gains = np.add.reduceat(drawn**2, starts, axis=0)
        # Of those with as many directions the largest gain is the least likely.
        largest = (
            log_tail(gains[freedom[used] == many].max(axis=0), many) for many in np.unique(freedom[used]).tolist()
        )
        lowest = np.append(lowest, np.min(list(largest), axis=0))
        if len(lowest) >= DRAWS or (lowest <= own.min()).sum() >= ENOUGH:
            break
    beaten, none = (lowest[:, None] <= own).sum(axis=0), 1 / (len(lowest) + 1)
    # Far beyond the draws, Bonferroni's bound says more than that no draw came near.
    bound = np.where(own < FAR * lowest.min(), np.minimum(np.exp(own) * len(used), none), none)
    chances[used] = np.where(beaten > 0, (beaten + 1) * none, bound)
    return chances
