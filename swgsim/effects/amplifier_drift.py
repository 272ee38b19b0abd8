"""Imperfection: amplifier and excitation drift."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import on_gauges, since_session


@dataclass(frozen=True)
class AmplifierDrift(Effect):
    """Gain of all bridges, zeros included, moves in proportion to the time of the session (physics.md AC6).

    Signature: mean and all orders of all gauges alike, growing with the time of the session, whatever load and speed.
    Typical: 0.02 to 0.1 % while the amplifier warms up by 10 K, which is taken to last an hour (an estimate).

    Attributes
    ----------
    rate : float
        [1/h], up to 0.02 (beyond, no calibration would hold for a session) both ways.
    """

    place = "acquisition"
    rate: float = size(unit="1/h", low=-0.02, high=0.02, typical=5e-4)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the gauges scaled."""
        gain = 1 + self.rate * since_session(scene) / 3600
        return on_gauges(channels, lambda _, signal: gain * signal)
