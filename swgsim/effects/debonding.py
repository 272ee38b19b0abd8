from dataclasses import dataclass

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.one_gauge import weights
from swgsim.effects.quantity import choice, size
from swgsim.effects.turns import since_session


@dataclass(frozen=True)
class Debonding(Effect):
    """The bond of one gauge gives way, so that it shows 1 - rate t of the strain at the time t of the session.

    The source is physics.md SE15. What it lost before the session is a gain error. A drift of one amplifier channel
    looks the same.

    Signature: mean and all orders of this gauge fall by one share with time, at any load and speed. Typical: 1 % per
    hour (an estimate; in the end the whole signal is lost).

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4.
    rate : float
        [1/h], from -0.2 to 0.2 (beyond, nothing is left of a long session).
    """

    place = "gauge"
    sensor: int = choice(low=0, high=4)
    rate: float = size(unit="1/h", low=-0.2, high=0.2, typical=0.01)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals, that of the gauge without what is lost."""
        return signals * (1 - self.rate * since_session(scene) / 3600 * weights(self.sensor))
