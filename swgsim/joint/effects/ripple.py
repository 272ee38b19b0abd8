"""Effect: a wave over the angle of the joint, through the joint's resonance or its sensor's filter."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import choice, shape
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term

# Frequency at which the amplitudes of waves that grow with speed are stated [Hz].
STATED = 100.0
# A corner so high that nothing is filtered [Hz].
OPEN = 2000.0


@dataclass(frozen=True)
class Ripple(Term):
    """A wave of a fixed number per revolution of the output, A cos(order q) + B sin(order q).

    What makes it may be a deviation of the wave generator, the teeth, the motor or the output bearing (kinematic
    error, physics.md DY7; ripple of a torque sensor by gauges off their places; cogging, DY9), constant in amplitude
    or growing with the first or second power of speed, as a position error seen by damping or inertia does. The
    signal follows it as a second-order system does, a resonance of the joint or the filter of its sensor.

    Attributes
    ----------
    order : float
        Waves per revolution of the output.
    power : int
        Of the speed in its amplitude, from 0 to 2.
    corner : float
        Of resonance or filter [Hz], from 20 to 2000, where nothing is filtered.
    damping : float
        Of resonance or filter, as a share of the critical one, from 0.1 to 1.5.
    """

    explains: ClassVar[tuple[str, ...]] = ("current", "T_sensor")
    needs: ClassVar[tuple[str, ...]] = ("q", "omega")
    order: float = shape(1.0, unit="-", low=0.25, high=1e5)
    power: int = choice(0, low=0, high=2)
    corner: float = shape(OPEN, unit="Hz", low=20, high=OPEN, points=9)
    damping: float = shape(0.7, unit="-", low=0.1, high=1.5, points=4)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine, as the signal follows them."""
        wave = np.exp(1j * self.order * recording.signals["q"]) * self.response(recording.speed)
        return np.stack([wave.real, wave.imag], axis=1)

    def response(
        self, omega: Float[np.ndarray, "*speed"], lower: Float[np.ndarray, "*speed"] | float = 1.0
    ) -> np.ndarray:
        """Complex amplitude at speeds of the output [rad/s], for one of 1 before the filter at STATED, where the corner
        is so many times ``lower``.
        """
        frequency = self.order * omega / (2 * np.pi)
        x = frequency * lower / self.corner if self.corner < OPEN else 0.0
        return (1j * frequency / STATED) ** self.power / (1 - x**2 + 2j * self.damping * x)

    def units(self, of: str) -> tuple[str, ...]:
        """Of both amplitudes: as they are, or at 100 Hz if they grow with speed."""
        return (of,)

    @property
    def amplitude(self) -> float:
        """Of the wave, in the unit of the signal."""
        return float(np.linalg.norm(self.weights))

    @property
    def phase(self) -> float:
        """At which angle order * q it is largest [rad], before the filter."""
        return float(np.arctan2(self.weights[1], self.weights[0]))
