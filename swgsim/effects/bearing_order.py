"""Imperfection: a line of the wave generator's bearing at a non-integer order."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, random_phase, shape, size

# Positions of s1 to s4 [rad].
POSITIONS = np.pi / 2 * np.arange(4)


@dataclass(frozen=True)
class BearingOrder(Effect):
    """Unequal balls or a damaged race: a pattern that travels around at a non-integer order (physics.md FS11).

    Each of s1 to s4 gains amplitude (preload + (1 - preload) T / 70 N m) cos(order phi_in - waves beta - phase) at its
    position beta. The all-round bridge s0 takes no part, as its four pairs, 90 degrees apart, cancel such patterns; of
    no waves, a breathing of the ring, it shows as much as the others. A map over one revolution cannot hold a
    non-integer order, so it is added to the signals. Signature: one line at the order, from gauge to gauge a quarter
    turn times ``waves`` behind, growing with load, alike at all speeds. Sidebands at the order +-2, as the lobes load
    the balls, are left out. Typical: 0.05 to 1 % of order 2, which is 0.17 mV/V.

    Attributes
    ----------
    amplitude : float
        At 70 N m [mV/V], from 0 to 0.02.
    order : float
        Per revolution of the wave generator, from 0.4 to 13.
    waves : int
        Around the circumference, 0 to 3; four gauges see m + 4 waves as m, and 3 as one that travels backwards.
    preload : float
        Share of the load on the balls at 70 N m that the deflection makes by itself; an estimate.
    phase : float
        [rad].
    """

    place = "wave generator"
    amplitude: float = size(unit="mV/V", low=0, high=0.02, typical=0.5e-3)
    order: float = shape(0.455, unit="-", low=0.4, high=13, points=253)
    waves: int = choice(1, low=0, high=3)
    preload: float = shape(0.3, unit="-", low=0, high=1)
    phase: float = random_phase()

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with the line added."""
        load = self.preload + (1 - self.preload) * scene.T_out / FULL_LOAD
        wave = np.cos(self.order * scene.phi_in - self.waves * POSITIONS[:, None] - self.phase)
        of_s0 = wave[0] * (self.waves == 0)
        return signals + self.amplitude * load * np.vstack([of_s0, wave])
