"""Effect: friction that grows with the load."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.kinematics import play
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True)
class LoadDependentFriction(Term):
    """The load presses on flanks and balls, mu |T|: Coulomb friction of the mesh (physics.md DY4) and Palmgren's M1 of
    the wave generator's bearing, as in the effects load dependent friction and bearing friction of the chain. Its sense
    follows the distance since the motion turned, as the flanks stick to one another before they slide.

    Signature: a residual that changes its sign with the direction of motion and is large where the load is; none on an
    axis that carries no load. Typical: 5 to 20 % of the load's own current.

    Attributes
    ----------
    distance : float
        At which they slide [rad], from 2e-4, which is a sign, to 0.05.
    """

    needs = ("q", "T_rigid")
    distance: float = shape(2e-3, unit="rad", low=2e-4, high=5e-2, points=8)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Size of the load with the sense of the friction."""
        return (np.abs(recording.signals["T_rigid"]) * play(recording.signals["q"], self.distance))[:, None]

    def units(self, of: str) -> tuple[str, ...]:
        """Of mu."""
        return (f"{of}/(N m)",)

    @property
    def sound(self) -> bool:
        """Friction brakes."""
        return all(weight > 0 for weight in self.weights)
