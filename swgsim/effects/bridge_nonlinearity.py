from dataclasses import dataclass

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, size

# Signal at which a cubic one has the size of a square one [mV/V], that of a gauge at full load.
FULL = 0.25


@dataclass(frozen=True)
class BridgeNonlinearity(Effect):
    """A bridge or amplifier is not linear: a signal s shows as s + share s^2, in one bridge or in all.

    A bridge with equal strain in opposite grids is linear, so unequal grids and the amplifier cause this (physics.md
    SE10). With power 3 both signs bend alike, s + share s^3 / 0.25 mV/V.

    Signature: order 4 and the mean of s1 to s4 change by half of share A_2^2, at any load. Order 2 changes by twice
    share times mean, in proportion to the load. In s0 mainly the mean changes, with the square of the load. The cube
    adds order 6. Typical: 2e-3 per mV/V, that of a quarter bridge.

    Attributes
    ----------
    share : float
        [1/(mV/V)], from -0.2 to 0.2 (of an amplifier out of order).
    sensor : int
        Number of the gauge, from 0 to 4; 5 for all of them.
    power : int
        2 or 3.
    """

    place = "gauge"
    share: float = size(unit="1/(mV/V)", low=-0.2, high=0.2, typical=2e-3)
    sensor: int = choice(ALL, low=0, high=ALL)
    power: int = choice(2, low=2, high=3)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals, bent."""
        return signals + self.share * weights(self.sensor) * signals**2 * (signals / FULL) ** (self.power - 2)
