from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.quantity import shape, size
from swgsim.effects.turns import since_session


@dataclass(frozen=True)
class SelfHeating(Effect):
    """The excitation warms the grids after power-on: all zeros drift by drift (1 - exp(-t / time_constant)).

    The time t counts from the beginning of the session (physics.md SE14). All zeros drift equally, because all bridges
    are built and fed alike.

    Signature: the mean of all gauges, with time, at any load and speed. Typical: 5 to 50 um/m, 0.0025 to 0.025 mV/V,
    with 10 to 100 s.

    Attributes
    ----------
    drift : float
        In the end [mV/V], from -0.1 to 0.1 (beyond, the excitation is set wrongly).
    time_constant : float
        [s], from 5 to 600.
    """

    place = "gauge"
    drift: float = size(unit="mV/V", low=-0.1, high=0.1, typical=0.01)
    time_constant: float = shape(30.0, unit="s", low=5, high=600, points=7)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with their zeros moved."""
        return signals - self.drift * np.expm1(-since_session(scene) / self.time_constant)
