"""Effects: waves over the angle of the joint, filtered by a resonance or by the sensor."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import choice, shape
from swgsim.joint.recording import OF_DRIVE, PREDICTED, JointRecording
from swgsim.joint.term import Term

# Frequency at which the amplitudes of waves that grow with speed are given [Hz].
STATED = 100.0
# A corner frequency so high that nothing is filtered [Hz].
OPEN = 2000.0


@dataclass(frozen=True)
class Ripple(Term):
    """A wave of a fixed number per revolution of the output, A cos(order q) + B sin(order q).

    Causes are deviations of the wave generator, the teeth, the motor or the output bearing (kinematic error,
    physics.md DY7; misplaced gauges of a torque sensor; cogging, DY9). The amplitude is constant, or grows with the
    first or second power of speed, as a position error does through damping or inertia. The signal follows the wave as
    a second-order system does: a resonance of the joint or the filter of its sensor.

    Attributes
    ----------
    order : float
        Waves per revolution of the output.
    power : int
        Power of the speed in the amplitude, from 0 to 2.
    corner : float
        Frequency of resonance or filter [Hz], from 20 to 2000; at 2000 nothing is filtered.
    damping : float
        Damping ratio of resonance or filter, from 0.1 to 1.5.
    """

    explains: ClassVar[tuple[str, ...]] = PREDICTED
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
        """Complex amplitude at speeds of the output [rad/s] for a wave of amplitude 1 at the frequency STATED before
        the filter. ``lower`` divides the corner frequency.
        """
        frequency = self.order * omega / (2 * np.pi)
        x = frequency * lower / self.corner if self.corner < OPEN else 0.0
        return (1j * frequency / STATED) ** self.power / (1 - x**2 + 2j * self.damping * x)

    @property
    def amplitude(self) -> float:
        """Amplitude in the unit of the signal; at 100 Hz if it grows with speed."""
        return float(np.linalg.norm(self.weights))

    @property
    def phase(self) -> float:
        """Angle order * q of the maximum [rad], before the filter."""
        return float(np.arctan2(self.weights[1], self.weights[0]))


@dataclass(frozen=True)
class InertiaRipple(Ripple):
    """A ripple through a resonance between a spring (the gear or the speed control) and the inertia J of the arm. Its
    frequency goes with 1 / sqrt(J), its amplitude with 1 / J (an estimate of form).

    Amplitude and corner frequency are given for 1 kg m^2. The effect is for a joint with an upright axis, where
    rigid-body torque and posture give the inertia (:func:`swgsim.joint.kinematics.inertia`).
    """

    explains = OF_DRIVE
    needs = ("q", "omega", "T_rigid")
    of_whole = True
    per = (" kg m^2",)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine, as the signal follows them at the inertia of each moment."""
        J = recording.inertia
        if J is None:
            raise ValueError(f"recording {recording.name} gives no inertia of {recording.joint}: use a ripple")
        wave = np.exp(1j * self.order * recording.signals["q"]) * self.response(recording.speed, np.sqrt(J)) / J
        return np.stack([wave.real, wave.imag], axis=1)

    def possible(self, recording: JointRecording) -> bool:
        """Whether the inertia is known."""
        return super().possible(recording) and recording.inertia is not None
