"""Imperfection: creep of the gauges' bond."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import shape, size
from swgsim.effects.turns import mean_over_turns, since_session


@dataclass(frozen=True)
class BondCreep(Effect):
    """Adhesive and backing yield under a lasting strain: 1 + share (1 - exp(-t / time_constant)) of it is shown at time
    t after it began (physics.md SE7), which is taken to be the beginning of the session.

    Signature: the mean of all gauges, in proportion to the torque and growing with the time of the session. The orders
    keep their amplitude: a strain that alternates within milliseconds does not creep in minutes. Typical: 0.02 to 0.1 %
    in 30 minutes; negative where the end loops of the grid are short (an estimate).

    Attributes
    ----------
    share : float
        Up to 0.05 (beyond, the bond has failed) both ways.
    time_constant : float
        [s], from 60 to 7200; what is slower is a straight line within a session.
    """

    place = "gauge"
    share: float = size(unit="-", low=-0.05, high=0.05, typical=0.001)
    time_constant: float = shape(900.0, unit="s", low=60, high=7200, points=7)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with more of their means."""
        crept = -np.expm1(-since_session(scene) / self.time_constant)
        return signals + self.share * mean_over_turns(signals, scene) * crept
