"""Imperfection: zero of the input's torque flange."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class FlangeZero(Effect):
    """The flange at the input shows a torque too much (physics.md DY14).

    Signature: the mean of T_in, so the efficiency, most at small loads (at 7 N m the input takes 0.15 N m); it looks
    like less or more friction but is the same at all speeds, and the gauges stay. Typical: 5 mN m, 0.1 to 0.2 % of a
    flange for a few N m.

    Attributes
    ----------
    zero : float
        [N m], up to 0.1 both ways; beyond, the efficiency at small loads would pass 1.
    """

    place = "acquisition"
    zero: float = size(unit="N m", low=-0.1, high=0.1, typical=0.005)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the input torque moved."""
        return {**channels, "T_in": channels["T_in"] + self.zero}
