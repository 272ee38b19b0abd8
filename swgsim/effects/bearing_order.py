from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, random_phase, shape, size

# Positions of s1 to s4 [rad].
POSITIONS = np.pi / 2 * np.arange(4)


@dataclass(frozen=True)
class BearingOrder(Effect):
    """Unequal balls or a damaged race: a pattern travels around the collar at a non-integer order (physics.md FS11).

    A gauge at the angle beta from s1 gains amplitude (preload + (1 - preload) T / 70 N m) cos(order phi_in - waves beta
    - phase). The all-round bridge s0 gains nothing, because its four grid pairs cancel such patterns; without waves (a
    breathing ring) s0 gains as much as the others. A map over one revolution cannot hold a non-integer order, so the
    effect adds it to the signals.

    Signature: one line at the order, which lags by ``waves`` quarter turns from gauge to gauge. It grows with load and
    does not depend on speed. The model leaves out sidebands at the order +-2, which come from the passing lobes.
    Typical: 0.05 to 1 % of order 2, which is 0.17 mV/V.

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
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    """

    place = "wave generator"
    amplitude: float = size(unit="mV/V", low=0, high=0.02, typical=0.5e-3)
    order: float = shape(0.455, unit="-", low=0.4, high=13, points=253)
    waves: int = choice(1, low=0, high=3)
    preload: float = shape(0.3, unit="-", low=0, high=1)
    phase: float = random_phase()

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with the line added."""
        load = self.preload + (1 - self.preload) * scene.T_out / FULL_LOAD
        wave = np.cos(self.order * scene.phi_in - self.waves * POSITIONS[:, None] - self.phase)
        of_s0 = wave[0] * (self.waves == 0)
        return signals + self.amplitude * load * np.vstack([of_s0, wave])
