from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class EncoderEccentricity(Effect):
    """The disc of the input's encoder is off centre: phi_in shows as phi_in + error sin(phi_in + phase).

    The speed shows as the rate of this angle, unless another encoder measures it (physics.md AC7). The speed control
    uses the motor's own encoder.

    Signature: order 1 of n_in, in proportion to the speed, if this encoder measures it. Over the measured angle, order
    n of all gauges gains sidebands n - 1 and n + 1 of n / 2 error A_n, so orders 1 and 3. Over time the gauges do not
    change. Typical: 0.05 to 0.2 degree.

    Attributes
    ----------
    error : float
        [rad], from 0 to 0.02 (0.2 mm at a disc of 20 mm in diameter).
    phase : float
        Of the wave at phi_in = 0, the major axis at s1 [rad].
    tells_speed : int
        1 if n_in is the rate of this angle, 0 if another encoder measures the speed.
    """

    place = "acquisition"
    error: float = size(unit="rad", low=0, high=0.02, typical=0.0017)
    phase: float = phase()
    tells_speed: int = choice(1, low=0, high=1)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with angle and speed as the encoder shows them."""
        angle = scene.phi_in + self.phase
        return {
            **channels,
            "phi_in": channels["phi_in"] + self.error * np.sin(angle),
            "n_in": channels["n_in"] * (1 + self.tells_speed * self.error * np.cos(angle)),
        }
