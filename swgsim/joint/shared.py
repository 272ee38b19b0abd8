"""What effects share with the textbook model to which they are added: the sign of the motion, and the load."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import shape
from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.joint.term import Term


@dataclass(frozen=True, kw_only=True)
class OfFriction(Term):
    """Friction of the gear, which brakes the motion.

    Attributes
    ----------
    side : int
        1 if the signal to explain is on the motor's side of the friction, as the current is, so that it is larger by
        the friction; -1 if the load is on the motor's side, and the signal on the output's.
    """

    explains = PREDICTED
    side: int = 1

    def added_to(self, terms: Sequence[Term]) -> Any:
        """On the side of the model's friction."""
        return replace(super().added_to(terms), side=_of_model(OfFriction, terms, self).side)


@dataclass(frozen=True, kw_only=True)
class OfMotion(Term):
    """A term whose change with the motion is so fast that the filters of signals shift it.

    Attributes
    ----------
    lag : float
        Time by which the signal follows the motion [s]: current and speed pass different filters. It is fitted with
        the textbook model, and all terms of a model have the same.
    """

    lag: float = shape(0.0, unit="s", low=-1.0, high=1.0)

    def added_to(self, terms: Sequence[Term]) -> Any:
        """With the lag of the model."""
        return replace(super().added_to(terms), lag=_of_model(OfMotion, terms, self).lag)


@dataclass(frozen=True, kw_only=True)
class OfSign(OfMotion, OfFriction):
    """Friction with the sign of the motion.

    Attributes
    ----------
    sign_width : float
        Speed within which the sign changes [rad/s]. It is fitted with Coulomb friction of the textbook, and all terms
        of a model have the same.
    """

    sign_width: float = shape(0.01, unit="rad/s", low=1e-9, high=1e3)

    def sense(self, recording: JointRecording) -> Float[np.ndarray, " time"]:
        """The sign of the friction in the signal."""
        return self.side * recording.sense(self.sign_width, self.lag)

    def added_to(self, terms: Sequence[Term]) -> Any:
        """With the sign of the model."""
        return replace(super().added_to(terms), sign_width=_of_model(OfSign, terms, self).sign_width)


@dataclass(frozen=True, kw_only=True)
class OfLoad(Term):
    """A term with the load of the gear.

    Attributes
    ----------
    measured : bool
        Whether the load is that of the torque sensor, or else that of the rigid-body model.
    link : tuple of float
        Without both: inertia, and gravity over cosine and sine of the angle, of the single link of the textbook, in the
        unit of the signal. Empty if there is a torque.
    """

    measured: bool = False
    link: tuple[float, ...] = ()

    @property
    def signal_of_load(self) -> str:
        """Name of the signal."""
        return "T_sensor" if self.measured else "T_rigid"

    def load(self, recording: JointRecording) -> Float[np.ndarray, " time"]:
        """The load [N m], or in the unit of the signal that of a link."""
        return link(recording) @ np.array(self.link) if self.link else recording.signals[self.signal_of_load]

    def units(self, of: str) -> tuple[str, ...]:
        """Units of the weights; those of a load in the unit of the signal for a link."""
        return tuple(unit.replace("(N m)", of).replace("N m", of) if self.link else unit for unit in super().units(of))

    def possible(self, recording: JointRecording) -> bool:
        """Whether a recording has the load, and all other signals."""
        return super().possible(recording) and (bool(self.link) or self.signal_of_load in recording.signals)

    def added_to(self, terms: Sequence[Term]) -> Any:
        """With the load of the model."""
        model = _of_model(OfLoad, terms, self)
        return replace(super().added_to(terms), measured=model.measured, link=model.link)


def link(recording: JointRecording, lag: float = 0.0) -> Float[np.ndarray, "time 3"]:
    """Acceleration, and cosine and sine of the angle, of a single link."""
    angles, own = recording.links
    acceleration = recording.later(recording.acceleration, lag)
    return np.stack([acceleration, np.cos(angles[own]), np.sin(angles[own])], axis=1)


def _of_model(kind: type, terms: Sequence[Term], own: Term) -> Any:
    """First term of a kind in a model, from which others take what they share; the own one if there is none."""
    return next((each for each in terms if isinstance(each, kind)), own)
