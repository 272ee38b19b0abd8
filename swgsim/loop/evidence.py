"""Whether an effect is the cause and no mimic: one size must serve all operating points, channels and orders."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq
from scipy.stats import chi2

from swgsim.loop.fitting import Fitted
from swgsim.loop.model import predict

# A real cause never has the library's exact shape: its parts may differ from it by this share (standard deviation).
FORM_TOLERANCE = 0.2
# Probability below which the parts contradict one another even so.
CONTRADICTION = 1e-4


@dataclass(frozen=True)
class Coherence:
    """How well one size of an effect serves all of its signature.

    Attributes
    ----------
    chance : float
        Probability of such a disagreement between the parts, if their form is right to FORM_TOLERANCE.
    form_error : float
        Share by which the parts differ from the library's shape, as far as it can be seen.
    """

    chance: float
    form_error: float

    @property
    def holds(self) -> bool:
        """Whether the parts agree."""
        return self.chance > CONTRADICTION


def signature(fitted: Fitted, number: int) -> Float[np.ndarray, " row"]:
    """What one effect of the model does to the features, by the chain with and without it."""
    measured = fitted.measured
    found = predict([fitted.model, fitted.model.without(number)], measured.situations, measured.layout)
    return measured.rows(found[0] - found[1])


def coherence(fitted: Fitted, number: int) -> Coherence:
    """Split the signature of an effect by operating point, channel and order, and see whether the parts agree."""
    whole = signature(fitted, number)
    layout = fitted.measured.layout
    channels, orders = (np.tile(what, len(fitted.measured)) for what in (layout.channel, layout.order))
    parts = [
        *fitted.measured.point_rows(),
        *(channels == c for c in layout.channels),
        *(orders == k for k in np.unique(orders)),
    ]
    split = fitted.whole.whiten(np.stack([whole * part for part in parts], axis=1))
    U, s, _ = np.linalg.svd(split, full_matrices=False)
    seen = s > 1e-3 * max(float(s.max()), 1e-12)
    u, s = (U.T @ fitted.whole.whiten(fitted.from_start))[seen], s[seen]

    def disagreement(tolerance: float) -> float:
        return float((u**2 / (1 + (tolerance * s) ** 2)).sum())

    chance = float(chi2.sf(disagreement(FORM_TOLERANCE), len(s)))
    if disagreement(0) <= len(s):
        return Coherence(chance, 0.0)
    if disagreement(10) > len(s):
        return Coherence(chance, 10.0)
    return Coherence(chance, float(brentq(lambda x: disagreement(x) - len(s), 0, 10)))
