"""An interharmonic line without a known cause, as an effect: one line, one pattern, one law.

The identification returns it where no effect of the library fits.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from swgsim.common.checks import require_known
from swgsim.effects.base import Channels, Effect, Samples, Scene
from swgsim.effects.quantity import random_phase, shape, size
from swgsim.effects.regularity import LAWS, PATTERNS, with_wave
from swgsim.storage.labelled_signals import SENSORS

GAUGE_PATTERNS = {name: pattern for name, pattern in PATTERNS.items() if set(pattern) <= set(SENSORS)}


@dataclass(frozen=True)
class LineBetween(Effect, ABC):
    """A line in the gauges whose phase differs in every recording; a subclass gives its frequency.

    Attributes
    ----------
    amplitude : float
        At 70 N m, 4000 rpm, 10 K above 25 degC or after 1 h, as the law needs them [mV/V], from 0 to 100.
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

    @abstractmethod
    def angle(self, scene: Scene) -> Samples:
        """Phase angle of the line [rad]."""

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the line on the gauges of the pattern."""
        amplitude = self.amplitude * LAWS[self.law](scene.point, scene.conditions)
        return with_wave(channels, self.pattern, amplitude * np.exp(1j * (self.angle(scene) - self.phase)))


@dataclass(frozen=True)
class FractionalOrder(LineBetween):
    """A line that turns with the wave generator, such as of a bearing or of a gearbox at the input.

    Signature: as the parameters say. Typical: one hundredth of order 2.

    Attributes
    ----------
    order : float
        Per revolution of the wave generator, from 0 to 50.
    """

    order: float = shape(0.5, unit="-", low=0, high=50, points=501)

    def angle(self, scene: Scene) -> Samples:
        """Phase angle of the line [rad]."""
        return self.order * scene.phi_in


@dataclass(frozen=True)
class FixedFrequency(LineBetween):
    """A line with one frequency at all speeds, such as of a resonance, a converter or a machine nearby.

    Signature: as the parameters say. Typical: one hundredth of order 2.

    Attributes
    ----------
    frequency : float
        [Hz], from 0 to 4000.
    """

    frequency: float = shape(25.0, unit="Hz", low=0, high=4000, points=4001)

    def angle(self, scene: Scene) -> Samples:
        """Phase angle of the line since the trigger [rad]."""
        return 2 * np.pi * self.frequency * scene.time
