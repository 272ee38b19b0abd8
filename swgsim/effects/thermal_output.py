from dataclasses import dataclass

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.one_gauge import ALL, weights
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class ThermalOutput(Effect):
    """The grids of one bridge, or of all, expand unequally: the zero drifts by slope dT (physics.md SE5).

    The law is linear near 25 degC.

    Signature: the mean of this gauge, or of all, in proportion to the temperature, at any load and speed. Typical: 0.1
    to 1 um/m per K of mismatch; a pair gives 0.5e-3 mV/V per um/m.

    Attributes
    ----------
    sensor : int
        Number of the gauge, from 0 to 4; 5 for all of them.
    slope : float
        [mV/V per K], from -5e-3 to 5e-3 (10 um/m per K, bare foil on the wrong material).
    """

    place = "gauge"
    sensor: int = choice(low=0, high=ALL)
    slope: float = size(unit="mV/V per K", low=-5e-3, high=5e-3, typical=2.5e-4)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with zeros moved."""
        return signals + self.slope * scene.conditions.warmer * weights(self.sensor)
