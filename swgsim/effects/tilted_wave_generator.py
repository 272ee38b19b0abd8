from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import phase, shape, size

# Half the width over which the wave generator touches the sleeve [m], of the default flex spline.
HALF_BAND = 5.5e-3


@dataclass(frozen=True)
class TiltedWaveGenerator(Effect):
    """The axis of the wave generator is tilted, fixed to the flex spline (physics.md FS5); an approximation.

    The chain has one displacement across the band, that of its middle. A tilt about a pivot at the distance ``lever``
    shifts the middle by tilt lever cos(angle - theta). The coned sleeve touches the cam at one end of the band at the
    major axis and at the other end at the minor one. These points are -b/2 cos 2(angle - psi) from the middle, where
    the cam stands off by tilt times this distance. To first order the displacement gains

        tilt cos(angle - theta) (lever - b/2 cos 2(angle - psi)).

    The model leaves out that a load on the shaft tilts it further.

    Signature: opposite offsets of opposite gauges, as with an eccentric wave generator, and order 2 with opposite signs
    in opposite gauges. There are no odd orders, as the two lobes are alike. With a long lever it is an eccentric wave
    generator, with lever 0 nearly an uneven sleeve. Typical: 0.1 to 1 mrad (estimate).

    Attributes
    ----------
    tilt : float
        [rad], from 0 to 3 mrad; the cone of the sleeve is 11 mrad steep, and the touching ends must stay the same.
    theta : float
        Direction to which the open end tilts, from gauge s1 in the sense of phi_in [rad].
    lever : float
        From the pivot of the shaft to the middle of the band [m], negative if the pivot is beyond the open end; an
        estimate.
    """

    place = "wave generator"
    tilt: float = size(unit="rad", low=0, high=3e-3, typical=0.5e-3)
    theta: float = phase()
    lever: float = shape(20e-3, unit="m", low=-40e-3, high=40e-3)

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement plus what the tilt makes of it where the cam touches."""
        arm = self.lever - HALF_BAND * np.cos(2 * (theta - psi[:, None]))
        return displacement + self.tilt * np.cos(theta - self.theta) * arm
