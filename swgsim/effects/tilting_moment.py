from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, phase, size
from swgsim.flexspline.gauges import waves

WAVE = waves(1)


@dataclass(frozen=True)
class TiltingMoment(Effect):
    """A tilting moment or radial load bends the collar: gauges gain strain cos(beta_i - theta) (physics.md SE16).

    A weight gives a constant moment; a belt or lever gives one in proportion to the torque. A static field of three
    waves, as of three bolts, is the same at gauges 90 degrees apart (SE18).

    Signature: opposite means of opposite gauges, constant or in proportion to the load; s0 and the orders stay. An
    eccentric wave generator is similar but also changes even orders under load. Typical: 0.5 to 1 % of full scale,
    0.001 mV/V, per rated moment; up to 5 % on a thin collar.

    Attributes
    ----------
    strain : float
        [mV/V], at 70 N m if it follows the load, from 0 to 0.1 (nearly all of the signal by 70 N m; beyond, the output
        bearing is overloaded).
    theta : float
        Direction of the moment, from gauge s1 in the sense of phi_in [rad].
    with_load : int
        1 if it is in proportion to the load, 0 if it is constant.
    """

    place = "gauge"
    strain: float = size(unit="mV/V", low=0, high=0.1, typical=0.002)
    theta: float = phase()
    with_load: int = choice(0, low=0, high=1)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with the offsets of one wave around the collar."""
        strain = self.strain * (scene.T_out / FULL_LOAD) ** self.with_load
        return signals + strain * (WAVE * np.exp(-1j * self.theta)).real
