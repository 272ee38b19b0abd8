from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Field, Psi, Theta
from swgsim.effects.off_centre import OffCentre, unequal_lobes
from swgsim.effects.quantity import phase, size


@dataclass(frozen=True)
class RotatingEccentricity(OffCentre):
    """The cam is off the axis of its shaft and turns with it: a displacement e cos(angle - psi - phase).

    The source is physics.md FS3; psi is the angle of the major axis from s1.

    Signature: order 1 in s1 to s4. It lags by a quarter turn from gauge to gauge, so it is opposite in opposite gauges.
    As one lobe carries more, small lines of orders 1 and 3 grow with load, unless both lobes carry alike. Order 0 does
    not change, unlike with a fixed eccentricity. Typical: 5 to 35 um by the assembly tolerances of size 17; less where
    an Oldham coupling lets the cam centre itself.

    Attributes
    ----------
    e : float
        Eccentricity [m], from 0 to 0.15 mm; beyond, the teeth of one lobe would leave engagement.
    phase : float
        Direction of the eccentricity, from the major axis in the sense of phi_in [rad].
    unequal : float
        How unequally the lobes share the load: 0 if both carry alike, 1 in proportion to their depth, as in the
        paper's chain, up to 3 for stiff teeth (an estimate).
    """

    e: float = size(unit="m", low=0, high=0.15e-3, typical=15e-6)
    phase: float = phase()
    unequal: float = unequal_lobes()

    def shift(self, psi: Psi, theta: Theta) -> Field:
        """Of the cam, seen from an angle while it turns [m]."""
        return self.e * np.cos(theta - psi[:, None] - self.phase)
