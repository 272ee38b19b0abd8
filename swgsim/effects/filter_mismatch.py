"""Imperfection: filters that are not alike."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class FilterMismatch(Effect):
    """The anti-alias filter of one channel lags the others by a first order, 1 / (1 + i omega lag), or leads them by
    its inverse (physics.md AC2). The window is taken to repeat, which whole revolutions do.

    Signature: order n of this gauge lags by about n omega_in lag, in proportion to the speed and whatever the load; the
    mean stays. Typical: 0.1 to 1 degree of order 2 at 4000 rpm, 2 to 20 us.

    Attributes
    ----------
    sensor : int
    lag : float
        Time constant [s], up to 500e-6 (a corner at 320 Hz, well within the signal) both ways.
    """

    place = "acquisition"
    sensor: int = choice(low=0, high=4)
    lag: float = size(unit="s", low=-500e-6, high=500e-6, typical=10e-6)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with one of them filtered."""
        return on_gauges(channels, lambda s, signal: self._filtered(signal, scene.time) if s == self.sensor else signal)

    def _filtered(
        self, signal: Float[np.ndarray, " time"], time: Float[np.ndarray, " time"]
    ) -> Float[np.ndarray, " time"]:
        if self.lag <= 0:
            return signal - self.lag * CubicSpline(time, signal)(time, 1)
        omega = 2 * np.pi * np.fft.rfftfreq(len(time), time[1] - time[0])
        return np.fft.irfft(np.fft.rfft(signal) / (1 + 1j * omega * self.lag), len(time))
