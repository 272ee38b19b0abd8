"""Imperfection: gauge factor with temperature."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class GaugeFactorTemperature(Effect):
    """The gauge factor of all grids grows with temperature, 1 + slope dT (physics.md SE6).

    Signature: mean and all orders of all gauges alike, in proportion to the temperature. The zeros are scaled with the
    strain, which errs by less than 1e-4 mV/V. The modulus of the steel, -2.5e-4 per K, is not of this form: it raises
    the strain by the torque and leaves the strain that the wave generator imposes. Typical: 1e-4 per K (constantan; an
    estimate).

    Attributes
    ----------
    slope : float
        [1/K], up to 1e-3 (semiconductor gauges have more) both ways.
    """

    place = "gauge"
    slope: float = size(unit="1/K", low=-1e-3, high=1e-3, typical=1e-4)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals, scaled."""
        return signals * (1 + self.slope * scene.conditions.warmer)
