"""Imperfection: gain of a torque flange."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, size


@dataclass(frozen=True)
class FlangeGain(Effect):
    """The flange at the output, or at the input, shows 1 + share of the torque (physics.md DY14).

    Signature: the channel T_out or T_in and so the efficiency in the same proportion at every load; the gauges stay and
    seem, beside T_out, to have another sensitivity to torque. Typical: 0.1 to 0.2 %.

    Attributes
    ----------
    share : float
        Up to 0.05 (beyond, the flange is not calibrated) both ways.
    at_input : int
        1 for the flange at the input, 0 for that at the output.
    """

    place = "acquisition"
    share: float = size(unit="-", low=-0.05, high=0.05, typical=0.002)
    at_input: int = choice(0, low=0, high=1)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with one torque scaled."""
        name = "T_in" if self.at_input else "T_out"
        return {**channels, name: channels[name] * (1 + self.share)}
