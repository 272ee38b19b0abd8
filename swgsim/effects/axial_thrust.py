from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class AxialThrust(Effect):
    """The thrust between wave generator and flex spline dishes the collar in proportion to the torque.

    Gauges s1 to s4 gain strain T / 70 N m (physics.md SE17). Ideal grids do not feel it. The wiring of the arms decides
    whether the all-round bridge s0 averages it away.

    Signature: means of s1 to s4 in proportion to the load, and their torque ripple. As s0 shows twice as much of the
    torque, s0 and s1 to s4 disagree on the torque. Typical: 0.5 to 2 % of full scale, 0.0006 to 0.0023 mV/V.

    Attributes
    ----------
    strain : float
        At 70 N m [mV/V], from -0.02 to 0.02 (a sixth of the signal).
    on_s0 : int
        1 if s0 shows it as the others do, 0 if it averages it away.
    """

    place = "gauge"
    strain: float = size(unit="mV/V", low=-0.02, high=0.02, typical=0.0015)
    on_s0: int = choice(0, low=0, high=1)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals plus a share of the thrust."""
        feels = np.array([[self.on_s0], [1.0], [1.0], [1.0], [1.0]])
        return signals + self.strain / FULL_LOAD * feels * scene.T_out
