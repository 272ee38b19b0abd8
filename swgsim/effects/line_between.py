"""What no physical effect explains between the integer orders, as an effect all the same: one line, pattern and law."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.checks import require_known
from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import random_phase, size
from swgsim.effects.regularity import LAWS, PATTERNS, with_wave
from swgsim.recordings import SENSORS

GAUGE_PATTERNS = {name: pattern for name, pattern in PATTERNS.items() if set(pattern) <= set(SENSORS)}


@dataclass(frozen=True)
class LineBetween(Effect):
    """A line in the gauges, with another phase in every recording; where it lies, a subclass says.

    Attributes
    ----------
    amplitude : float
        At 70 N m, 4000 rpm, 10 K above 25 degC or after 1 h, where the law has them [mV/V], from 0 to 100.
    phase : float
        Of cos(angle - phase) [rad].
    pattern : str
        Of :data:`GAUGE_PATTERNS`.
    law : str
        Of :data:`swgsim.effects.regularity.LAWS`.
    """

    place = "acquisition"
    amplitude: float = size(unit="mV/V", low=0, high=100, typical=1e-3)
    phase: float = random_phase()
    pattern: str = "the same in all gauges"
    law: str = "constant"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_known(f"pattern of {self.title()}", [self.pattern], GAUGE_PATTERNS)
        require_known(f"law of {self.title()}", [self.law], LAWS)

    def angle(self, scene: Scene) -> Float[np.ndarray, " time"]:
        """How far the line has turned [rad]."""
        raise NotImplementedError

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the line on the gauges of the pattern."""
        amplitude = self.amplitude * LAWS[self.law](scene.point, scene.conditions)
        return with_wave(channels, self.pattern, amplitude * np.exp(1j * (self.angle(scene) - self.phase)))
