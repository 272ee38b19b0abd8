"""Effects: friction that depends on speed, direction, angle or load, without memory."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.recording import JointRecording
from swgsim.joint.shared import OfFriction, OfLoad, OfSign


@dataclass(frozen=True)
class AsymmetricFriction(OfSign):
    """Coulomb and viscous friction that are larger in one direction, because flanks and seals ran in that way
    (physics.md DY6: 14 % in one drive). The weights are half of the difference.

    Signature: a residual that keeps its sign when the motion reverses, and is zero at rest.
    """

    weight_names = ("Coulomb half difference", "viscous half difference")
    per = ("", " s/rad")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The part of each friction that keeps its sign."""
        return np.stack([np.abs(self.sense(recording)), np.abs(recording.speed)], axis=1)


@dataclass(frozen=True)
class QuadraticFriction(OfSign):
    """Friction with the square of the speed, c omega^2, besides viscous friction: grease that is thrown, or the cubic
    part of eq. (5) over a range of speeds (an estimate of form).
    """

    per = (" s^2/rad^2",)
    brakes = True

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The square of the speed, with the sign of the friction."""
        return (self.sense(recording) * recording.speed**2)[:, None]


@dataclass(frozen=True)
class SublinearFriction(OfSign):
    """Friction c |omega|^p of grease that is churned or thinned by shear. Palmgren's exponent is 2/3, as in the effect
    churning loss of the chain.

    Attributes
    ----------
    power : float
        Exponent p from 0.2 to 0.7; near 0 it equals Coulomb friction, near 1 viscous friction.
    """

    per = (" (s/rad)^p",)
    brakes = True
    power: float = shape(2 / 3, unit="-", low=0.2, high=0.7, points=5)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The power of the speed, with the sign of the friction."""
        return (self.sense(recording) * np.abs(recording.speed) ** self.power)[:, None]


@dataclass(frozen=True)
class StribeckFriction(OfSign):
    """Friction that rises by b_s exp(-(omega / v_s)^2) at low speed, where no film carries the flanks (physics.md DY2),
    as the effect Stribeck friction of the chain, in the speed of the output.

    Attributes
    ----------
    v_s : float
        Speed at which 37 % of it remains [rad/s], from 0.02 to 0.5.
    """

    brakes = True
    v_s: float = shape(0.1, unit="rad/s", low=0.02, high=0.5, points=7)

    @classmethod
    def title(cls) -> str:
        """With the capital of a person's name."""
        return "Stribeck friction"

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The friction of thin films."""
        return (self.sense(recording) * np.exp(-((recording.speed / self.v_s) ** 2)))[:, None]


@dataclass(frozen=True)
class LoadViscosity(OfFriction, OfLoad):
    """Viscous friction in proportion to the load, c |T| omega, as more balls and flanks carry (an estimate of form).

    Signature: load friction that rises with speed.
    """

    per = (" s/(N m rad)",)
    brakes = True

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Size of the load times the speed."""
        return (self.side * np.abs(self.load(recording)) * recording.speed)[:, None]


@dataclass(frozen=True)
class PositionFriction(OfSign):
    """Friction that varies over the angle, sign(omega) (A cos(order q) + B sin(order q)): one of the flanks or lobes is
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
        """Cosine and sine with the sign of the friction."""
        wave = np.exp(1j * self.order * recording.signals["q"]) * self.sense(recording)
        return np.stack([wave.real, wave.imag], axis=1)
