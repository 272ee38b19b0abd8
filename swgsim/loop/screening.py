"""Score test of every hypothesis, after taking out what the declared parameters can absorb.

No hypothesis is fitted here. The residual at the calibrated parameters is compared with the signature of every effect,
both weighed by the covariance of noise, single recordings and declared parameters; what a declared parameter would
absorb of a signature is gone by then, and only the rest counts.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from swgsim.loop.gaussian import Covariance
from swgsim.loop.hypotheses import Hypothesis

# Part of a signature that must remain visible beside the declared parameters; below, it cannot be told from them.
VISIBLE = 1e-4
# Directions of a signature below this part of its largest one are rounding.
NEGLIGIBLE = 1e-6
DRAWS = 2000


@dataclass(frozen=True)
class Score:
    """Score of one hypothesis.

    Attributes
    ----------
    hypothesis : Hypothesis
    gain : float
        Fall of the residual's sum of squares if the effect were added, in units of the noise.
    freedom : int
        Numbers that this would fit: 1, or 2 for a wave.
    estimate : float
        Expected size.
    phase : float
        Expected phase of a wave [rad].
    deviation : float
        Standard deviation of the size, declared parameters being open.
    visible : float
        Share of the signature that the declared parameters cannot absorb.
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
        """What hypotheses are ordered by: the gain, less what a search of this extent gains by luck."""
        return self.gain - self.freedom * np.log(1000) - 2 * np.log(self.hypothesis.tried)

    @property
    def detectable(self) -> float:
        """Smallest size that would be seen with 80 % power at the level of one in a hundred of the whole library."""
        return 5.0 * self.deviation


def screen(
    found: Sequence[Hypothesis],
    signatures: Sequence[Float[np.ndarray, "row column"]],
    residual: Float[np.ndarray, " row"],
    errors: Covariance,
    parameters: Float[np.ndarray, "row parameter"],
    rng: np.random.Generator,
) -> list[Score]:
    """Scores of all hypotheses, the best rank first.

    Parameters
    ----------
    found : sequence of Hypothesis
    signatures : sequence of array (row, column)
        Change by the typical size.
    residual : array (row,)
        Measured less predicted, at the calibrated parameters.
    errors : Covariance
        Noise and errors of single recordings.
    parameters : array (row, parameter)
        Change by one spread of each declared parameter.
    rng : Generator
    """
    whole = errors.with_columns(parameters)
    r = whole.whiten(residual)
    ends = np.cumsum([s.shape[1] for s in signatures])[:-1]
    stacked = np.hstack(list(signatures))
    weighed = np.split(whole.whiten(stacked), ends, axis=1)
    alone = np.split(errors.whiten(stacked), ends, axis=1)
    raw, bases = [], []
    for hypothesis, C, free in zip(found, weighed, alone, strict=True):
        U, s, Vt = np.linalg.svd(C, full_matrices=False)
        kept = s > NEGLIGIBLE * max(float(np.linalg.norm(free)), 1e-300)
        U, s, Vt = U[:, kept], s[kept], Vt[kept]
        visible = float((s**2).sum() / max(float((free**2).sum()), 1e-300))
        if visible < VISIBLE:
            U, s, Vt = U[:, :0], s[:0], Vt[:0]
        raw.append((hypothesis, U.T @ r, s, Vt, visible))
        bases.append(U)
    chances = _family_wise([u for _, u, *_ in raw], bases, rng)
    scores = [_score(*each, chance) for each, chance in zip(raw, chances, strict=True)]
    return sorted(scores, key=lambda score: -score.rank)


def best_of_kind(scores: Sequence[Score]) -> list[Score]:
    """The best hypothesis of every effect, in the order of the scores."""
    best: Mapping[type, Score] = {}
    for score in scores:
        best.setdefault(score.hypothesis.kind, score)  # type: ignore[attr-defined]
    return list(best.values())


def _score(
    hypothesis: Hypothesis, u: np.ndarray, s: np.ndarray, Vt: np.ndarray, visible: float, chance: float
) -> Score:
    """Figures of one hypothesis from its projections."""
    if not len(s):
        return Score(hypothesis, 0.0, 0, np.nan, np.nan, np.inf, visible, 1.0)
    from swgsim.effects.quantity import quantities

    quantity = quantities(hypothesis.kind)[hypothesis.size]
    span = hypothesis.typical - quantity.nothing
    weights = Vt.T @ (u / s)
    deviation = abs(span) / float(np.sqrt((s**2).mean()))
    if hypothesis.phase:
        cosine, sine = (*weights, 0.0)[:2]
        size, phase = span * float(np.hypot(cosine, sine)), float(np.arctan2(sine, cosine) % (2 * np.pi))
    else:
        size, phase = span * float(weights[0]), 0.0
    size = float(np.clip(quantity.nothing + size, quantity.low, quantity.high))
    return Score(hypothesis, float(u @ u), len(s), size, phase, deviation, visible, chance)


def _family_wise(
    projections: Sequence[np.ndarray], bases: Sequence[np.ndarray], rng: np.random.Generator
) -> np.ndarray:
    """Of every hypothesis, how often pure noise gives the whole library a score as high.

    Hypotheses overlap, so the scores of noise are drawn together, from the inner products of their directions.
    """
    stacked = np.hstack(bases)
    freedom = np.array([basis.shape[1] for basis in bases])
    if not stacked.shape[1]:
        return np.ones(len(bases))
    values, vectors = np.linalg.eigh(stacked.T @ stacked)
    root = vectors * np.sqrt(np.maximum(values, 0))
    drawn = (root @ rng.standard_normal((len(values), DRAWS))) ** 2
    used = np.flatnonzero(freedom)
    starts = np.concatenate([[0], np.cumsum(freedom[used])[:-1]])
    sums = np.add.reduceat(drawn, starts, axis=0)
    lowest = chi2.logsf(sums, freedom[used, None]).min(axis=0)
    own = np.zeros(len(bases))
    own[used] = [chi2.logsf(projections[i] @ projections[i], freedom[i]) for i in used]
    beaten = (lowest[:, None] <= own[None, :]).sum(axis=0)
    # Far beyond what draws can show, Bonferroni's bound is the better answer.
    bound = np.minimum(1.0, np.exp(np.minimum(own, 0)) * len(used))
    return np.where(beaten > 0, (beaten + 1) / (DRAWS + 1), np.minimum(bound, 1 / (DRAWS + 1)))
