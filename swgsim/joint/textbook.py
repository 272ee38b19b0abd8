"""The textbook model of a joint: inertia, gravity, Coulomb and viscous friction, and the zero of its sensor."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording, turns_back
from swgsim.joint.term import Term


@dataclass(frozen=True)
class RigidBody(Term):
    """Torque that moves the links: the controller's rigid-body model, or without one the inertia and gravity of a
    single link, J domega/dt + c cos q + s sin q.
    """

    modelled: bool = True
    explains = ("T_sensor", "current")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """One column with a model of the robot, three without."""
        if self.modelled:
            return recording.signals["T_rigid"][:, None]
        q = recording.signals["q"]
        return np.stack([recording.acceleration, np.cos(q), np.sin(q)], axis=1)

    def names(self) -> tuple[str, ...]:
        """Factor of the modelled torque, or the parts of a single link."""
        return ("factor of the rigid-body torque",) if self.modelled else ("inertia", "gravity cosine", "gravity sine")

    def units(self, of: str) -> tuple[str, ...]:
        """Per torque; or of inertia and two torques in the unit of the signal."""
        return (f"{of}/(N m)",) if self.modelled else (f"{of} s^2/rad", of, of)


@dataclass(frozen=True)
class Friction(Term):
    """Coulomb and viscous friction, b0 sign(omega) + b1 omega, as in eq. (5) without its cubic and angular parts."""

    weight_names = ("Coulomb friction", "viscous friction")
    per = ("", " s/rad")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Sign and speed of the motion."""
        return np.stack([recording.sense, recording.speed], axis=1)

    @property
    def sound(self) -> bool:
        """Friction brakes, or is absent."""
        return all(weight >= 0 for weight in self.weights)


@dataclass(frozen=True)
class Zero(Term):
    """A constant."""

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """A column of ones."""
        return np.ones((len(recording), 1))


def textbook(recordings: tuple[JointRecording, ...], of: str) -> tuple[Term, ...]:
    """The textbook's terms for a signal, as far as the recordings have the signals that these need.

    A torque sensor behind the gear does not measure friction of the gear, and its zero differs in every run. If no
    joint ever reverses, the zero of a current and Coulomb friction cannot be separated; the zero is then left out.
    """
    rigid = RigidBody(modelled=all("T_rigid" in each.signals for each in recordings))
    if of == "T_sensor":
        return (rigid,)
    return (rigid, Friction(), Zero()) if turns_back(recordings) else (rigid, Friction())
