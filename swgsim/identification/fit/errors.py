"""Errors of a model for fitted and for left-out recordings, and the noise floor from repeats.

Nuisance parameters, such as zeros and gains of sessions, are not errors of a model. They are estimated with the final
model from the other operating points or recordings, and subtracted from the errors before and after.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitted import Fitted


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of a model in every recording and channel, root mean square of the signal, in the channel's unit.

    Attributes
    ----------
    fitted : Fitted
    best : Fitted
        The final model, whose nuisance parameters are subtracted.
    """

    fitted: Fitted
    best: Fitted

    @cached_property
    def fit(self) -> Float[np.ndarray, "recording channel"]:
        """Errors of the fitted recordings."""
        return self._of(self.fitted.residual, self.best.nuisance)

    @cached_property
    def repeats(self) -> Float[np.ndarray, "recording channel"]:
        """Of every recording by the model fitted to all others, its repeats among them; NaN where it has none."""
        nuisance = self.best.nuisance_by(self.best.by_other_recordings)
        return self._of(_left_out(self.fitted, self.fitted.by_other_recordings), nuisance)

    @cached_property
    def heldout(self) -> Float[np.ndarray, "recording channel"]:
        """Of every operating point by the model fitted to the others; NaN if there is one only."""
        return self._of(_left_out(self.fitted, self.fitted.by_others), self.best.nuisance)

    def _of(
        self, missed: Float[np.ndarray, " row"], nuisance: Float[np.ndarray, " row"]
    ) -> Float[np.ndarray, "recording channel"]:
        return per_recording(self.fitted.measured, missed - nuisance)


def _left_out(fitted: Fitted, told: Sequence[tuple[np.ndarray, np.ndarray]]) -> Float[np.ndarray, " row"]:
    """Errors of every block of rows by the model fitted to all others; NaN in no block."""
    missed = np.full(len(fitted.residual), np.nan)
    for block, directions in told:
        parameters = directions[len(directions) - len(fitted.parameters) :]
        missed[block] = fitted.from_start[block] - fitted.J[block] @ parameters
    return missed


def repeat_noise(measured: Measured) -> Float[np.ndarray, "recording feature"] | None:
    """What repeats of the same operating point differ by, as large as noise is by which they do; None where nothing was
    repeated.
    """
    if not measured.spare:
        return None
    return measured.about_repeats(measured.values) * np.sqrt(len(measured) / measured.spare)


def noise_floor(measured: Measured) -> Float[np.ndarray, " channel"]:
    """Root mean square of what repeats differ by; NaN where nothing was repeated."""
    noise = repeat_noise(measured)
    return per_channel(measured, np.full(measured.values.size, np.nan) if noise is None else noise.ravel())


def relative(measured: Measured, error: Float[np.ndarray, "*recording channel"]) -> float:
    """Root mean square over channels, and recordings that have an error, of errors as shares of the channel's own root
    mean square; NaN where none is known.
    """
    return rms(error / per_channel(measured, measured.values.ravel()))


def rms(error: np.ndarray) -> float:
    """Root mean square of the known values; NaN if there are none."""
    known = error[np.isfinite(error)]
    return float(np.sqrt(np.mean(known**2))) if known.size else np.nan


def size(measured: Measured) -> Float[np.ndarray, " channel"]:
    """How much there is to explain: the ripple of every channel, without its mean."""
    ripple = measured.values * (measured.layout.order > 0)
    return per_channel(measured, ripple.ravel())


def per_channel(measured: Measured, rows: Float[np.ndarray, " row"]) -> Float[np.ndarray, " channel"]:
    """Root mean square over recordings of the signal that feature rows stand for."""
    return np.sqrt((per_recording(measured, rows) ** 2).mean(axis=0))


def per_recording(measured: Measured, rows: Float[np.ndarray, " row"]) -> Float[np.ndarray, "recording channel"]:
    """Root mean square of the signal that feature rows stand for."""
    squares = (rows.reshape(measured.values.shape) ** 2) * np.where(measured.layout.order == 0, 1.0, 0.5)
    channels = squares.reshape(len(measured), len(measured.layout.channels), -1)
    return np.sqrt(channels.sum(axis=2))
