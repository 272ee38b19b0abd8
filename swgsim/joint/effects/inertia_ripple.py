"""Effect: a wave over the angle of a joint whose arm answers it the less the farther it reaches."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.recording import JointRecording


@dataclass(frozen=True)
class InertiaRipple(Ripple):
    """A ripple through a resonance of a spring, that of the gear or of the speed control, with the inertia J of the
    arm: its frequency goes with 1 / sqrt(J), and what the same torque moves with 1 / J (an estimate of form).

    Amplitude and corner are stated for 1 kg m^2. For a joint with an upright axis, whose inertia the rigid-body torque
    and the posture say (:mod:`swgsim.joint.inertia`).
    """

    explains = ("current",)
    needs = ("q", "omega", "T_rigid")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine, as the signal follows them at the inertia of each moment."""
        J = recording.inertia
        if J is None:
            raise ValueError(f"recording {recording.name} does not say the inertia of {recording.joint}: use a ripple")
        wave = np.exp(1j * self.order * recording.signals["q"]) * self.response(recording.speed, np.sqrt(J)) / J
        return np.stack([wave.real, wave.imag], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of both amplitudes, times the inertia."""
        return (f"{of} kg m^2",)

    @classmethod
    def possible(cls, recording: JointRecording) -> bool:
        """Whether the inertia is known."""
        return super().possible(recording) and recording.inertia is not None
