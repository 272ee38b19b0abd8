"""Without a cause: a line at a fixed frequency."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Scene
from swgsim.effects.line_between import LineBetween
from swgsim.effects.quantity import shape


@dataclass(frozen=True)
class FixedFrequency(LineBetween):
    """A line that keeps its frequency at all speeds, such as of a resonance, a converter or a machine nearby.

    It is what a loop that was closed gives back where no effect of the library fits; it names no cause. Signature: as
    its parameters say. Typical: a hundredth of order 2.

    Attributes
    ----------
    frequency : float
        [Hz], from 0 to 4000.
    """

    frequency: float = shape(25.0, unit="Hz", low=0, high=4000, points=4001)

    def angle(self, scene: Scene) -> Float[np.ndarray, " time"]:
        """How far the line has turned since the trigger [rad]."""
        return 2 * np.pi * self.frequency * scene.time
