"""Effects with a fixed size, which effects of load, speed or temperature become at one operating point."""

from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import size

# Reference load [N m] and speed [rpm] of laws: the limit for repeated peaks of a size 17, ratio 100 gear, and the
# higher speed of the paper.
FULL_LOAD, FULL_SPEED = 70.0, 4000.0


def turned(field: Field, angle: float) -> Field:
    """A field turned ahead around the circumference by an angle [rad], through its Fourier series."""
    points = field.shape[1]
    turn = np.exp(-1j * angle * np.arange(points // 2 + 1))
    return np.fft.irfft(np.fft.rfft(field, axis=1) * turn, points, axis=1)


@dataclass(frozen=True)
class ScaledDisplacement(Effect):
    """The imposed displacement times a factor.

    Attributes
    ----------
    factor : float
        From 0.3 to 2.
    """

    place = "wave generator"
    factor: float = size(unit="-", low=0.3, high=2, typical=1.05, nothing=1)

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement times the factor."""
        return displacement * self.factor


@dataclass(frozen=True)
class TurnedDisplacement(Effect):
    """The imposed displacement turned ahead.

    Attributes
    ----------
    angle : float
        [rad], from -0.5 to 0.5.
    """

    place = "wave generator"
    angle: float = size(unit="rad", low=-0.5, high=0.5, typical=0.05)

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement at angles further back."""
        return turned(displacement, self.angle)


@dataclass(frozen=True)
class PoweredShare(Effect):
    """The shares of the tooth force raised to a power; below one, they spread more evenly over the engaged arc.

    Attributes
    ----------
    exponent : float
        From 0.1 to 10.
    """

    place = "mesh"
    exponent: float = size(unit="-", low=0.1, high=10, typical=0.7, nothing=1)

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """The shares to the power of the exponent."""
        return share**self.exponent
