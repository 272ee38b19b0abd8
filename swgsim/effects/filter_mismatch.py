from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from swgsim.effects.base import Channels, Effect, Samples, Scene
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class FilterMismatch(Effect):
    """The anti-alias filter of one channel lags the others by 1 / (1 + i omega lag), or leads by the inverse.

    The source is physics.md AC2. The filter treats the window as periodic, which whole revolutions are.

    Signature: order n of this gauge lags by about n omega_in lag, in proportion to the speed and at any load; the mean
    stays. Typical: 0.1 to 1 degree of order 2 at 4000 rpm, 2 to 20 us.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    lag : float
        Time constant [s], from -500e-6 to 500e-6 (a corner at 320 Hz, well within the signal).
    """

    place = "acquisition"
    sensor: int = choice(low=0, high=4)
    lag: float = size(unit="s", low=-500e-6, high=500e-6, typical=10e-6)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with one of them filtered."""
        return on_gauges(channels, lambda s, signal: self._filtered(signal, scene.time) if s == self.sensor else signal)

    def _filtered(self, signal: Samples, time: Samples) -> Samples:
        if self.lag <= 0:
            return signal - self.lag * CubicSpline(time, signal)(time, 1)
        omega = 2 * np.pi * np.fft.rfftfreq(len(time), time[1] - time[0])
        return np.fft.irfft(np.fft.rfft(signal) / (1 + 1j * omega * self.lag), len(time))
