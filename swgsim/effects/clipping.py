"""Imperfection: amplifiers that saturate."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class Clipping(Effect):
    """No gauge shows more than a level, plus or minus (physics.md AC9).

    Signature: flat peaks; with the torque's mean, the upper ones first, so mean and order 2 of s1 to s4 fall and order
    4 appears, beyond some load only. Typical: 0.25 mV/V, a little below the peaks at 70 N m.

    Attributes
    ----------
    level : float
        [mV/V], from 0.01 (little of the signal is left) to 10 (nothing is cut).
    """

    place = "acquisition"
    sharp = True
    level: float = size(unit="mV/V", low=0.01, high=10, typical=0.25, nothing=10, further=(0.2, 0.15, 0.1), scale=0.1)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the gauges cut."""
        return on_gauges(channels, lambda _, signal: np.clip(signal, -self.level, self.level))
