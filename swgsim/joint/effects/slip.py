"""Effects: friction with memory, which builds up over a distance after each reversal."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.kinematics import play
from swgsim.joint.recording import JointRecording
from swgsim.joint.shared import OfFriction, OfLoad

# Each element slips at so many times the distance of the element before.
NEXT, ELEMENTS = 5.0, 2


@dataclass(frozen=True)
class LoadDependentFriction(OfFriction, OfLoad):
    """The load presses on flanks and balls, mu |T|: Coulomb friction of the mesh (physics.md DY4) and Palmgren's M1 of
    the wave generator's bearing, as in the effects load dependent friction and bearing friction of the chain. Its sign
    follows the distance since the last reversal, because the flanks stick to one another before they slide.

    Signature: a residual that changes its sign with the direction of motion and is large where the load is large. An
    axis without load does not show it. Typical: 5 to 20 % of the current of the load.

    Attributes
    ----------
    distance : float
        Distance at which the flanks slide [rad], from 2e-4, which is a plain sign, to 0.05.
    """

    needs = ("q",)
    per = ("/(N m)",)
    brakes = True
    distance: float = shape(2e-3, unit="rad", low=2e-4, high=5e-2, points=8)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Size of the load with the sign of the friction."""
        slip = self.side * play(recording.signals["q"], self.distance)
        return (np.abs(self.load(recording)) * slip)[:, None]


@dataclass(frozen=True)
class MaxwellSlip(OfFriction):
    """Hysteresis and lost motion: flex spline, seals and grease bend elastically before they slip, so that friction
    follows the distance since the last reversal and not the speed (Maxwell slip; physics.md DY1, DY12).

    The model has two elements; the second slips at five times the distance of the first.

    Attributes
    ----------
    distance : float
        Distance at which the first element slips [rad], from 2e-4 to 0.05.
    """

    needs = ("q",)
    weight_names = ("first element", "second element")
    distance: float = shape(2e-3, unit="rad", low=2e-4, high=5e-2, points=8)

    @classmethod
    def title(cls) -> str:
        """With the capital of a person's name."""
        return "Maxwell slip"

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Strain of each element, as a share of the strain at which it slips."""
        q = recording.signals["q"]
        return self.side * np.stack([play(q, self.distance * NEXT**number) for number in range(ELEMENTS)], axis=1)

    def least(self, columns: int) -> Float[np.ndarray, " column"]:
        """No element drives."""
        return np.zeros(columns)

    @property
    def has_physical_sign(self) -> bool:
        """Friction brakes; one of the elements may be absent."""
        return max(self.weights) > 0
