"""Base of effects with an axis off centre: displacement of the sleeve, and load sharing of the two lobes."""

from abc import abstractmethod
from typing import Any

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import shape


def unequal_lobes() -> Any:
    """Declare how unequally the two lobes share the load (an estimate).

    0: soft teeth, both lobes carry alike. 1: in proportion to the depth of engagement, as in the paper's chain. Above:
    stiff teeth. A search tries several values if commissioning finds another structure than the model's.
    """
    return shape(1.0, unit="-", low=0, high=3, points=4, of_structure=True)


class OffCentre(Effect):
    """The lobe that engages deeper carries more of the load; how much more depends on the stiffness of the teeth.

    Attributes
    ----------
    unequal : float
        See :func:`unequal_lobes`; a subclass declares it after its own parameters.
    """

    place = "wave generator"
    unequal: float

    @abstractmethod
    def shift(self, psi: Psi, theta: Theta) -> Field | Theta:
        """Radial displacement by the shift of the axis [m]."""

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """The displacement plus the shift."""
        return displacement + self.shift(psi, theta)

    def engaged(self, depth: Field, psi: Psi, theta: Theta) -> Field:
        """The depth, with the share of the shift that loads the lobes unequally."""
        return depth if self.unequal == 1 else depth + (self.unequal - 1) * self.shift(psi, theta)
