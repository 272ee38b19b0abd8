"""Imperfection: eccentricity that turns with the wave generator."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import choice, phase, size


@dataclass(frozen=True)
class RotatingEccentricity(Effect):
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
    unequal : int
        1 if the lobe that sinks deeper carries more of the load, 0 if the teeth give way so far that both carry alike.
    """

    place = "wave generator"
    e: float = size(unit="m", low=0, high=0.15e-3, typical=15e-6)
    phase: float = phase()
    unequal: int = choice(1, low=0, high=1)

    def wave_generator(
        self,
        displacement: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The displacement plus the radial part of the shift."""
        return displacement + self._shift(psi, theta)

    def engaged(
        self,
        depth: Float[np.ndarray, "psi theta"],
        psi: Float[np.ndarray, " psi"],
        theta: Float[np.ndarray, " theta"],
    ) -> Float[np.ndarray, "psi theta"]:
        """The depth, with the shift or without."""
        return depth if self.unequal else depth - self._shift(psi, theta)

    def _shift(
        self, psi: Float[np.ndarray, " psi"], theta: Float[np.ndarray, " theta"]
    ) -> Float[np.ndarray, "psi theta"]:
        return self.e * np.cos(theta - psi[:, None] - self.phase)
