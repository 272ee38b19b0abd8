"""Form errors of effects: what they add to the evidence of an option."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.linalg import cholesky, solve_triangular


@dataclass(frozen=True, eq=False)
class Forms:
    """Directions in which the forms of effects are open, and what a residual has along them, all whitened.

    Attributes
    ----------
    products : array (direction, direction)
        Of the directions with one another, for a form error of 1.
    along : array (direction,)
        Of the directions with the residual.
    effect : array (direction,)
        Number of the effect that each direction belongs to.
    misfit : float
        Sum of squares of the residual beyond its expectation.
    """

    products: Float[np.ndarray, "direction direction"]
    along: Float[np.ndarray, " direction"]
    effect: Int[np.ndarray, " direction"]
    misfit: float

    @classmethod
    def of(cls, white: Sequence[Float[np.ndarray, "row _"]], residual: Float[np.ndarray, " row"]) -> "Forms":
        """From the whitened directions of every effect, and the whitened residual."""
        every = np.hstack([np.zeros((len(residual), 0)), *white])
        effect = np.repeat(np.arange(len(white)), [each.shape[1] for each in white])
        return cls(every.T @ every, every.T @ residual, effect, float(residual @ residual) - len(residual))

    def gain(self, errors: Sequence[float]) -> float:
        """Gain of log-likelihood if the form of every effect is open by its form error."""
        scale = np.array(errors)[self.effect]
        L = cholesky(np.eye(len(scale)) + scale[:, None] * self.products * scale, lower=True)
        found = solve_triangular(L, scale * self.along, lower=True)
        return float(found @ found) / 2 - float(np.log(np.diag(L)).sum())
