"""Form errors of effects: what they add to the evidence of an option."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.linalg import cholesky, solve_triangular

from swgsim.identification.decide.line_errors import LineErrors


@dataclass(frozen=True, eq=False)
class OpenLines:
    """Errors of lines that the effects of an option have.

    Attributes
    ----------
    errors : LineErrors
    along : array (column,)
        What the residual has along their directions.
    largest : array (effect,)
        Largest line of each effect, in standard deviations of the noise; 0 if its lines do not differ one by one.
    """

    errors: LineErrors
    along: Float[np.ndarray, " column"]
    largest: Float[np.ndarray, " effect"]

    def gain(self, errors: Sequence[float]) -> float:
        """Gain of log-likelihood if the lines of every effect may differ by its form error."""
        return float(self.errors.gain(self.along, np.array((self.largest * errors).max())))

    def opened(self, errors: Sequence[float]) -> Float[np.ndarray, "row column"]:
        """Errors of lines, one standard deviation each, as the residual tells."""
        return self.errors.columns * self.errors.deviations(self.along, float((self.largest * errors).max()))


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
    lines : OpenLines, optional
        On a gear of another structure.
    """

    products: Float[np.ndarray, "direction direction"]
    along: Float[np.ndarray, " direction"]
    effect: Int[np.ndarray, " direction"]
    misfit: float
    lines: OpenLines | None = None

    @classmethod
    def of(
        cls,
        white: Sequence[Float[np.ndarray, "row _"]],
        residual: Float[np.ndarray, " row"],
        lines: OpenLines | None = None,
    ) -> "Forms":
        """From the whitened directions of every effect, and the whitened residual."""
        every = np.hstack([np.zeros((len(residual), 0)), *white])
        effect = np.repeat(np.arange(len(white)), [each.shape[1] for each in white])
        return cls(every.T @ every, every.T @ residual, effect, float(residual @ residual) - len(residual), lines)

    def gain(self, errors: Sequence[float]) -> float:
        """Gain of log-likelihood if the form of every effect is open by its form error."""
        scale = np.array(errors)[self.effect]
        L = cholesky(np.eye(len(scale)) + scale[:, None] * self.products * scale, lower=True)
        found = solve_triangular(L, scale * self.along, lower=True)
        of_lines = self.lines.gain(errors) if self.lines else 0.0
        return float(found @ found) / 2 - float(np.log(np.diag(L)).sum()) + of_lines
