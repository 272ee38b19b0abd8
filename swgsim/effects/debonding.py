"""Imperfection: a gauge that comes off."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.one_gauge import weights
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import since_session


@dataclass(frozen=True)
class Debonding(Effect):
    """The bond of one gauge gives way, so that it shows less and less of the strain: 1 - rate t of it at time t of the
    session (physics.md SE15). What it lost before is a gain; an amplifier of which one channel drifts looks the same.

    Signature: mean and all orders of this gauge alike, falling with the time of the session, whatever load and speed.
    Typical: 1 % per hour (an estimate; the end is the whole gauge).

    Attributes
    ----------
    sensor : int
        From 0 to 4.
    rate : float
        [1/h], up to 0.2 (beyond, nothing is left of a long session) both ways.
    """

    place = "gauge"
    sensor: int = choice(low=0, high=4)
    rate: float = size(unit="1/h", low=-0.2, high=0.2, typical=0.01)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals, that of the gauge without what is lost."""
        return signals * (1 - self.rate * since_session(scene) / 3600 * weights(self.sensor))
