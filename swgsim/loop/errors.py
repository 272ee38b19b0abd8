"""Error of a model per channel: on what it was fitted to, on operating points left out, and the floor of repeats.

Zeros and gains of sessions, and what is left open of the gear, are no error of a model. They are taken out, where the
other operating points tell that the best model has them, of this model and of that before it, which would hide in them
what it lacks.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.loop.fitted import Fitted
from swgsim.loop.session import Measured


@dataclass(frozen=True)
class Errors:
    """Root mean square over all order lines and recordings, one figure per channel, in its unit.

    Attributes
    ----------
    fit : array (channel,)
    heldout : array (channel,)
        Of every operating point, by the model fitted to the other points.
    """

    fit: Float[np.ndarray, " channel"]
    heldout: Float[np.ndarray, " channel"]


def errors(fitted: Fitted, best: Fitted) -> Errors:
    """Errors of a model on the recordings it was fitted to, without the nuisance that the best one finds."""
    fit = per_channel(fitted.measured, fitted.residual - best.nuisance)
    return Errors(fit, per_channel(fitted.measured, _left_out(fitted) - best.nuisance))


def of_points_left_out(fitted: Fitted) -> Float[np.ndarray, " point"]:
    """Root mean square error of every operating point, by the model fitted to the others, in units of the noise."""
    weighed = _left_out(fitted) ** 2 / fitted.errors.variance
    return np.array([np.sqrt(weighed[block].mean()) for block in fitted.measured.point_rows()])


def _left_out(fitted: Fitted) -> Float[np.ndarray, " row"]:
    """Errors of every operating point by the model fitted to the others; NaN where there is one only."""
    missed = np.full(len(fitted.residual), np.nan)
    for block, expected in fitted.by_others:
        parameters = expected.common[len(expected.common) - len(fitted.parameters) :]
        missed[block] = fitted.from_start[block] - fitted.J[block] @ parameters
    return missed


def noise_floor(measured: Measured) -> Float[np.ndarray, " channel"]:
    """What repeats of the same operating point differ by; NaN where nothing was repeated."""
    deviations, freedom = np.zeros(measured.values.shape), 0
    for group in dict.fromkeys(measured.repeats):
        rows = [i for i, each in enumerate(measured.repeats) if each == group]
        deviations[rows] = measured.values[rows] - measured.values[rows].mean(axis=0)
        freedom += len(rows) - 1
    if not freedom:
        return np.full(len(measured.layout.channels), np.nan)
    return per_channel(measured, deviations.ravel()) * np.sqrt(len(measured) / freedom)


def size(measured: Measured) -> Float[np.ndarray, " channel"]:
    """How much there is to explain: the ripple of every channel, without its mean."""
    ripple = measured.values * (measured.layout.order > 0)
    return per_channel(measured, ripple.ravel())


def per_channel(measured: Measured, rows: Float[np.ndarray, " row"]) -> Float[np.ndarray, " channel"]:
    """Root mean square over recordings of the signal that feature rows stand for."""
    squares = (rows.reshape(measured.values.shape) ** 2) * np.where(measured.layout.order == 0, 1.0, 0.5)
    channels = squares.reshape(len(measured), len(measured.layout.channels), -1)
    return np.sqrt(channels.sum(axis=2).mean(axis=0))
