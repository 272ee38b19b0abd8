"""Disturbance: axial thrust of the wave generator."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class AxialThrust(Effect):
    """The thrust between wave generator and flex spline, in proportion to the torque, dishes the collar: s1 to s4 show
    a share of it alike, strain T / 70 N m (physics.md SE17). Ideal grids feel none of it; whether the all-round bridge
    s0 averages it away or shows it too depends on how its arms are wired.

    Signature: means of s1 to s4 in proportion to the load, and their torque ripple; s0, which shows twice as much of
    the torque, stays or gains no more than they do, so that they disagree on the torque. Typical: 0.5 to 2 % of full
    scale, 0.0006 to 0.0023 mV/V.

    Attributes
    ----------
    strain : float
        At 70 N m [mV/V], up to 0.02 (a sixth of the signal) both ways.
    on_s0 : int
        1 if s0 shows it as the others do, 0 if it averages it away.
    """

    place = "gauge"
    strain: float = size(unit="mV/V", low=-0.02, high=0.02, typical=0.0015)
    on_s0: int = choice(0, low=0, high=1)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals plus a share of the thrust."""
        feels = np.array([[self.on_s0], [1.0], [1.0], [1.0], [1.0]])
        return signals + self.strain / FULL_LOAD * feels * scene.T_out
