from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from swgsim.effects.base import Channels, Effect, Samples, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import on_gauges
from swgsim.storage.labelled_signals import SENSORS


@dataclass(frozen=True)
class ChannelSkew(Effect):
    """A multiplexer scans s0 to s4 one after another: gauge i shows s_i(t - i delay).

    The source is physics.md AC1. Outside of the window the signal is taken from the next or the last revolution.

    Signature: order n of s_i lags by n i omega_in delay. The difference of opposite gauges therefore gains 2 n omega_in
    delay of A_n, in proportion to the speed and at any load. Typical: 10 to 100 us.

    Attributes
    ----------
    delay : float
        [s], up to 500e-6 (beyond, a scan of five channels takes longer than a sample at 400 Hz); negative where s4 is
        scanned first and the angle last.
    """

    place = "acquisition"
    delay: float = size(unit="s", low=-500e-6, high=500e-6, typical=50e-6)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with each gauge delayed."""
        turn = 2 * np.pi / scene.point.omega_in
        # One spline for all gauges, which takes no longer to make than one for a single gauge.
        spline = CubicSpline(scene.time, [channels[name] for name in SENSORS], axis=1)

        def delayed(sensor: int, _: Samples) -> Samples:
            then = scene.time - sensor * self.delay
            then = np.where(then < scene.time[0], then + turn, then)
            then = np.where(then > scene.time[-1], then - turn, then)
            return PPoly(spline.c[:, :, sensor], spline.x)(then)

        return on_gauges(channels, delayed)
