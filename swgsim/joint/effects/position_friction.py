"""Effect: friction that depends on the angle of the joint."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class PositionFriction(Term):
    """Friction varies over the angle, sign(omega) (A cos(order q) + B sin(order q)): one of the flanks or lobes is
    tighter (physics.md DY5), as in the effect position friction of the chain.

    Signature: a wave that changes its sign with the direction of motion. Typical: 3 to 10 % of the friction.

    Attributes
    ----------
    order : float
        Waves per revolution of the output.
    """

    needs = ("q", "omega")
    order: float = shape(1.0, unit="-", low=0.25, high=1e5)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine with the sense of the friction."""
        wave = np.exp(1j * self.order * recording.signals["q"]) * recording.sense
        return np.stack([wave.real, wave.imag], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of both amplitudes."""
        return (of,)
