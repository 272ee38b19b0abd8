"""Fault: tip tooth crack."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.checks import require
from swgsim.effects.base import Effect


@dataclass(frozen=True)
class TipToothCrack(Effect):
    """The tip of a tooth is cracked or gone: its force is strongly reduced (section II-B), the others take it over.

    Signature: short, small deviations twice per revolution, when a lobe passes the tooth; they grow with load.

    Attributes
    ----------
    force_loss : float
        Share of the tooth's force that is lost, from 0 to 1.
    theta : float
        Position of the tooth [rad].
    teeth : int
        Number of neighbouring teeth that are affected, from 1 to 10 (FE studies: one to ten of 200).
    flex_spline_teeth : int
        Number of teeth all around.
    """

    force_loss: float
    theta: float
    teeth: int = 1
    flex_spline_teeth: int = 200

    def __post_init__(self) -> None:
        require("the tip tooth crack", "force_loss", self.force_loss, low=0, high=1)
        require("the tip tooth crack", "theta", self.theta)
        require("the tip tooth crack", "teeth", self.teeth, low=1, high=10)

    def mesh(
        self,
        share: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The shares with less force on the cracked teeth; a sampled angle loses what it holds of their width."""
        pitch = theta[1] - theta[0]
        width = self.teeth * 2 * np.pi / self.flex_spline_teeth
        distance = np.abs((theta - self.theta + np.pi) % (2 * np.pi) - np.pi)
        covered = np.clip((width + pitch) / 2 - distance, 0, min(width, pitch)) / pitch
        return share * (1 - self.force_loss * covered)
