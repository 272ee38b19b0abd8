from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import angle, choice, shape, size

# Pitch of one tooth of 200 [rad].
TOOTH = 2 * np.pi / 200


@dataclass(frozen=True)
class TipToothCrack(Effect):
    """The tip of a tooth is cracked or gone, so its force F_tooth falls strongly.

    This is a fault of Table I (section II-B). The other teeth take the force over, unless something else also holds the
    output; the paper does not say which.

    Signature: short, small deviations twice per revolution, when a lobe passes the tooth; they grow with load. If
    nothing takes the force over, all gauges, mainly s0, show less torque at these times, several times as much.

    Attributes
    ----------
    force_loss : float
        Share of the tooth's force that is lost, from 0 to 1.
    theta : float
        Position of the tooth, from gauge s1 in the sense of phi_in [rad].
    width : float
        Angle of the affected teeth [rad], from one to ten teeth of 200, as in FE studies. The paper loads a node of its
        truss, which stands for several teeth; the default is four of 200.
    taken_over : int
        1 if the other teeth take the force over, 0 if nobody does.
    """

    place = "mesh"
    force_loss: float = size(unit="-", low=0, high=1, typical=0.5)
    theta: float = angle(points=40)
    width: float = shape(4 * TOOTH, unit="rad", low=TOOTH, high=10 * TOOTH)
    taken_over: int = choice(1, low=0, high=1)

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares with less force on the cracked teeth, if the others take it over."""
        return self._reduced(share, theta) if self.taken_over else share

    def carried(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares with less force on the cracked teeth, if nobody takes it over."""
        return share if self.taken_over else self._reduced(share, theta)

    def _reduced(self, share: Field, theta: Theta) -> Field:
        """A sampled angle loses what it holds of the width of the cracked teeth."""
        pitch = theta[1] - theta[0]
        distance = np.abs((theta - self.theta + np.pi) % (2 * np.pi) - np.pi)
        covered = np.clip((self.width + pitch) / 2 - distance, 0, min(self.width, pitch)) / pitch
        return share * (1 - self.force_loss * covered)
