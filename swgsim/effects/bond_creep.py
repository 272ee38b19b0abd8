from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.quantity import shape, size
from swgsim.effects.turns import mean_over_turns, since_session


@dataclass(frozen=True)
class BondCreep(Effect):
    """Adhesive and backing yield under a lasting strain, so that the gauges show more of it with time.

    At the time t they show 1 + share (1 - exp(-t / time_constant)) of the mean strain (physics.md SE7); t counts from
    the beginning of the session.

    Signature: the mean of all gauges, in proportion to the torque and growing with time. The orders keep their
    amplitude, because a strain that alternates within milliseconds does not creep in minutes. Typical: 0.02 to 0.1 % in
    30 minutes; negative where the end loops of the grid are short (an estimate).

    Attributes
    ----------
    share : float
        From -0.05 to 0.05 (beyond, the bond has failed).
    time_constant : float
        [s], from 60 to 7200; what is slower is a straight line within a session.
    """

    place = "gauge"
    share: float = size(unit="-", low=-0.05, high=0.05, typical=0.001)
    time_constant: float = shape(900.0, unit="s", low=60, high=7200, points=7)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with more of their means."""
        crept = -np.expm1(-since_session(scene) / self.time_constant)
        return signals + self.share * mean_over_turns(signals, scene) * crept
