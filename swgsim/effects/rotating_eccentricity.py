"""Imperfection: eccentricity that turns with the wave generator."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.off_centre import OffCentre, unequal_lobes
from swgsim.effects.quantity import phase, size


@dataclass(frozen=True)
class RotatingEccentricity(OffCentre):
    """The cam is off the axis of its shaft: e cos(theta - psi - phase), which turns with it (physics.md FS3).

    Signature: order 1 in s1 to s4, each a quarter turn behind the one before, so opposite in opposite gauges; as one
    lobe carries more, a little at orders 1 and 3 that grows with load, unless the lobes stay alike. Nothing at order 0,
    unlike a fixed eccentricity.
    Typical: 5 to 35 um by the assembly tolerances of size 17; less where an Oldham coupling lets the cam centre itself.

    Attributes
    ----------
    e : float
        Eccentricity [m], from 0 to 0.15 mm; beyond, the teeth of one lobe would leave engagement.
    phase : float
        Its direction, ahead of the major axis [rad].
    unequal : float
        By how much more than the other the lobe is loaded that sinks deeper: 0 if both carry alike, 1 in proportion to
        depth, as in the paper's chain, up to 3 for stiff teeth (an estimate).
    """

    e: float = size(unit="m", low=0, high=0.15e-3, typical=15e-6)
    phase: float = phase()
    unequal: float = unequal_lobes()

    def shift(
        self, psi: Float[np.ndarray, " psi"], theta: Float[np.ndarray, " theta"]
    ) -> Float[np.ndarray, "psi theta"]:
        """Of the cam, seen from an angle while it turns [m]."""
        return self.e * np.cos(theta - psi[:, None] - self.phase)
