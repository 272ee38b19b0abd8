"""Evidence of an effect whose lines differ one by one from the library's, on a gear of another structure.

The errors of its lines are known to a factor only (:mod:`line_errors`), so the residual that it leaves has no normal
distribution. The evidence is the likelihood of that residual at the fitted parameters of the effect, times the volume
of these: their prior density, and their spread about the fit with the errors of lines open.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import quantities
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.decide.line_errors import LineErrors, groups
from swgsim.identification.decide.prior import prior_ratio
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import signature
from swgsim.identification.fit.priors import name_of


@dataclass(frozen=True, eq=False)
class OpenLines:
    """Errors of the lines of an effect, and what the residual has along them.

    Attributes
    ----------
    errors : LineErrors
    along : array (column,)
        What the residual has along their directions.
    largest : float
        Largest lines of the effect, in standard deviations of the noise.
    misfit : float
        Sum of squares of the residual beyond its expectation.
    """

    errors: LineErrors
    along: Float[np.ndarray, " column"]
    largest: float
    misfit: float

    @classmethod
    def of(cls, fitted: Fitted, held: Fitted) -> "OpenLines":
        """Of the effect of a fit, given this with the effect known."""
        found = groups(fitted.measured)
        errors, directions = LineErrors.of(found, held.whole.whiten(found.columns))
        (number,) = fitted.numbers_added
        (largest,) = found.largest(signature(fitted, number)[None] @ found.weights).tolist()
        white = held.white
        return cls(errors, directions.T @ white, largest, float(white @ white) - len(white))

    def gain(self, errors: Sequence[float]) -> float:
        """Gain of log-likelihood if lines of the one effect differ by up to a share of the largest one."""
        (error,) = errors
        return float(self.errors.gain(self.along[None], np.array([self.largest * error]))[0])

    def opened(self, error: float) -> Float[np.ndarray, "row column"]:
        """Errors of lines, one standard deviation each, as the residual tells them."""
        return self.errors.columns * self.errors.deviations(self.along, self.largest * error)

    def share(self, error: float) -> float:
        """Root mean square of the errors, as a share of the largest lines."""
        off = self.errors.deviations(self.along, self.largest * error)
        return float(np.sqrt((off**2).mean()) / self.largest)


def with_effect_known(fitted: Fitted) -> Fitted:
    """The same fit, the parameters of its one added effect being known."""
    its = _of_effect(fitted)
    others = {name: parameter for name, parameter in fitted.parameters.items() if name not in its}
    position = {name: fitted.calibrated.position[name] for name in others}
    J = fitted.calibrated.J[..., [n for n, name in enumerate(fitted.parameters) if name in others]]
    return replace(fitted, parameters=others, calibrated=replace(fitted.calibrated, position=position, J=J))


def _of_effect(fitted: Fitted) -> list[str]:
    """The fitted parameters of the one added effect."""
    (number,), (effect,) = fitted.numbers_added, fitted.added
    its = {name_of(effect, number, each) for each in quantities(type(effect))}
    return [name for name in fitted.parameters if name in its]


def log_volume(fitted: Fitted, errors: Covariance) -> float:
    """Logarithm of the prior probability of the volume that the parameters of the effect fill about the fit.

    Parameters
    ----------
    fitted : Fitted
    errors : Covariance
        Of the residual with these parameters known, the errors of lines being open.
    """
    (number,), moved = fitted.numbers_added, _of_effect(fitted)
    white = errors.whiten(fitted.J[:, [list(fitted.parameters).index(name) for name in moved]])
    covariance = np.linalg.inv(white.T @ white + np.eye(len(moved)))
    spreads = zip(moved, np.sqrt(np.diag(covariance)), strict=True)
    deviation = {name: float(spread) * fitted.parameters[name].sd for name, spread in spreads}
    return float(np.linalg.slogdet(covariance)[1]) / 2 + prior_ratio(fitted, number, deviation)
