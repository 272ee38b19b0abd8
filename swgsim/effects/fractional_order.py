"""Without a cause: a line at an order between the integer ones."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Scene
from swgsim.effects.line_between import LineBetween
from swgsim.effects.quantity import shape


@dataclass(frozen=True)
class FractionalOrder(LineBetween):
    """A line that turns with the wave generator, such as of a bearing or a gearbox in front of it that nobody declared.

    It is what a loop that was closed gives back where no effect of the library fits; it names no cause. Signature: as
    its parameters say. Typical: a hundredth of order 2.

    Attributes
    ----------
    order : float
        Per revolution of the wave generator, from 0 to 50.
    """

    order: float = shape(0.5, unit="-", low=0, high=50, points=501)

    def angle(self, scene: Scene) -> Float[np.ndarray, " time"]:
        """How far the line has turned [rad]."""
        return self.order * scene.phi_in
