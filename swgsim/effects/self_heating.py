"""Imperfection: bridges that warm themselves up."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import shape, size
from swgsim.effects.turns import since_session


@dataclass(frozen=True)
class SelfHeating(Effect):
    """The excitation warms the grids after power-on, when the session begins: all zeros move by
    drift (1 - exp(-t / time_constant)) (physics.md SE14); alike, as all bridges are built and fed alike.

    Signature: the mean of all gauges, with the time of the session, whatever load and speed. Typical: 5 to 50 um/m,
    0.0025 to 0.025 mV/V, with 10 to 100 s.

    Attributes
    ----------
    drift : float
        In the end [mV/V], up to 0.1 (beyond, the excitation is set wrongly) both ways.
    time_constant : float
        [s], from 5 to 600.
    """

    place = "gauge"
    drift: float = size(unit="mV/V", low=-0.1, high=0.1, typical=0.01)
    time_constant: float = shape(30.0, unit="s", low=5, high=600, points=7)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals with their zeros moved."""
        return signals - self.drift * np.expm1(-since_session(scene) / self.time_constant)
