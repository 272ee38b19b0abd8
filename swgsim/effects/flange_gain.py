"""Imperfection: gain of the output's torque flange."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class FlangeGain(Effect):
    """The flange at the output shows 1 + share of the torque (physics.md DY14).

    Signature: the channel T_out and so the efficiency in the same proportion at every load; the gauges stay and seem to
    have another sensitivity to torque. Typical: 0.1 to 0.2 %.

    Attributes
    ----------
    share : float
        Up to 0.05 (beyond, the flange is not calibrated) both ways.
    """

    place = "acquisition"
    share: float = size(unit="-", low=-0.05, high=0.05, typical=0.002)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the output torque scaled."""
        return {**channels, "T_out": channels["T_out"] * (1 + self.share)}
