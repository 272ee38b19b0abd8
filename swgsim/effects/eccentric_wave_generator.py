from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Psi, Theta
from swgsim.effects.off_centre import OffCentre, unequal_lobes
from swgsim.effects.quantity import phase, size


@dataclass(frozen=True)
class EccentricWaveGenerator(OffCentre):
    """The axis of the wave generator is off centre by u_ecc = [r, theta, 0], fixed to the flex spline.

    This is a fault of Table I (section II-B): the imposed radial displacement gains r cos(angle - theta).

    Signature: opposite offsets of opposite gauges, one wave around the collar. Under load even orders change too,
    because the lobe that engages deeper carries more. There are no odd orders, as the two lobes are alike. Typical:
    0.02 to 0.15 mm; assembly tolerances allow 0.010 to 0.034 mm.

    Attributes
    ----------
    r : float
        Eccentricity [m], from 0 to 0.15 mm; beyond, the teeth of one lobe would leave engagement.
    theta : float
        Direction of the axis, from gauge s1 in the sense of phi_in [rad].
    unequal : float
        How unequally the lobes share the load: 0 if both carry alike, 1 in proportion to their depth, as in the
        paper's chain, up to 3 for stiff teeth (an estimate).
    """

    r: float = size(unit="m", low=0, high=0.15e-3, typical=0.05e-3)
    theta: float = phase()
    unequal: float = unequal_lobes()

    def shift(self, psi: Psi, theta: Theta) -> Theta:
        """Of the axis, seen from an angle [m]."""
        return self.r * np.cos(theta - self.theta)
