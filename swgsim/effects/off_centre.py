"""What an axis off centre does to the wave generator and to how its two lobes share the load."""

from abc import abstractmethod
from typing import Any

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import shape


def unequal_lobes() -> Any:
    """What the shift adds to the share of a lobe, beside what its depth does for the whole ellipse (an estimate).

    0 if the teeth give way so far that both lobes carry alike, 1 in proportion to depth, as in the paper's chain, more
    if they are stiff. A search leaves it open where commissioning finds another structure than the model's.
    """
    return shape(1.0, unit="-", low=0, high=3, points=4, of_structure=True)


class OffCentre(Effect):
    """The lobe that engages deeper carries more of the load; how much more depends on the stiffness of the teeth.

    Attributes
    ----------
    unequal : float
        Of :func:`unequal_lobes`; a subclass declares it behind its own parameters.
    """

    place = "wave generator"
    unequal: float

    @abstractmethod
    def shift(self, psi: Psi, theta: Theta) -> Field | Theta:
        """The radial part of the shift [m]."""

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement plus the shift."""
        return displacement + self.shift(psi, theta)

    def engaged(self, depth: Field, psi: Psi, theta: Theta) -> Field:
        """The depth, with as much of the shift as loads the lobes unequally."""
        return depth + (self.unequal - 1) * self.shift(psi, theta)
