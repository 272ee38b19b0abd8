"""The textbook model of a joint: inertia, gravity, Coulomb and viscous friction, and the zero of its sensor."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording, turns_back
from swgsim.joint.term import Term


@dataclass(frozen=True)
class RigidBody(Term):
    """What moves the links: the torque by the controller's rigid-body model; without one, inertia and gravity of a
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

    def units(self, of: str) -> tuple[str, ...]:
        """Share of a torque, or inertia and torques, in the unit of the signal."""
        return (f"{of}/(N m)",) if self.modelled else (f"{of} s^2/rad", of, of)


@dataclass(frozen=True)
class Friction(Term):
    """Coulomb and viscous friction, b0 sign(omega) + b1 omega, as in eq. (5) without its cubic and angular parts."""

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Its sense and its speed."""
        return np.stack([recording.sense, recording.speed], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of b0 and b1."""
        return of, f"{of} s/rad"

    @property
    def sound(self) -> bool:
        """Friction brakes."""
        return all(weight >= 0 for weight in self.weights)


@dataclass(frozen=True)
class Zero(Term):
    """A constant."""

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """One."""
        return np.ones((len(recording), 1))

    def units(self, of: str) -> tuple[str, ...]:
        """That of the signal."""
        return (of,)


def textbook(recordings: tuple[JointRecording, ...], of: str) -> tuple[Term, ...]:
    """The textbook's terms for a signal, as far as the recordings hold what they are made of.

    A torque sensor behind the gear sees no friction of the gear; its zero is another one in every run. Where no joint
    ever turns back, the zero of a current cannot be told from Coulomb friction and is taken to be nothing.
    """
    rigid = RigidBody(modelled=all("T_rigid" in each.signals for each in recordings))
    if of == "T_sensor":
        return (rigid,)
    return (rigid, Friction(), Zero()) if turns_back(recordings) else (rigid, Friction())
