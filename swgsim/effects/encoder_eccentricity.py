"""Imperfection: an encoder disc off centre."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class EncoderEccentricity(Effect):
    """The disc of the input's encoder turns off centre: phi_in shows as phi_in + error sin(phi_in + phase), and the
    speed as its rate, unless that is told by another encoder (physics.md AC7). The speed control is taken to follow the
    motor's own.

    Signature: order 1 of n_in, if that is its rate, in proportion to the speed; over the measured angle, sidebands
    n - 1 and n + 1 of n / 2 error A_n at order n of all gauges, so orders 1 and 3. In time the gauges stay. Typical:
    0.05 to 0.2 degree.

    Attributes
    ----------
    error : float
        [rad], from 0 to 0.02 (0.2 mm at a disc of 20 mm in diameter).
    phase : float
        [rad].
    tells_speed : int
        1 if n_in is its rate, 0 if another encoder tells it.
    """

    place = "acquisition"
    error: float = size(unit="rad", low=0, high=0.02, typical=0.0017)
    phase: float = phase()
    tells_speed: int = choice(1, low=0, high=1)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with angle and speed as the encoder shows them."""
        angle = scene.phi_in + self.phase
        return {
            **channels,
            "phi_in": channels["phi_in"] + self.error * np.sin(angle),
            "n_in": channels["n_in"] * (1 + self.tells_speed * self.error * np.cos(angle)),
        }
