from dataclasses import dataclass

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class GaugeFactorTemperature(Effect):
    """The gauge factor of all grids grows with temperature, by 1 + slope dT (physics.md SE6).

    Zeros are scaled with the strain, an error below 1e-4 mV/V. The modulus of the steel, -2.5e-4 per K, acts
    differently: it raises the strain by the torque only, not the strain that the wave generator imposes.

    Signature: mean and all orders of all gauges change by one share, in proportion to the temperature above 25 degC.
    Typical: 1e-4 per K (constantan; an estimate).

    Attributes
    ----------
    slope : float
        [1/K], from -1e-3 to 1e-3 (semiconductor gauges have more).
    """

    place = "gauge"
    slope: float = size(unit="1/K", low=-1e-3, high=1e-3, typical=1e-4)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals, scaled."""
        return signals * (1 + self.slope * scene.conditions.warmer)
