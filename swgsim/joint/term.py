"""The idea of an effect on a joint: columns over time, each with a weight that least squares finds."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.joint.recording import JointRecording


@dataclass(frozen=True, kw_only=True)
class Term(Effect, ABC):
    """What one physical effect adds to a signal of a joint.

    The parameters that it declares shape the columns; how much of each column there is, is a weight. Subclasses write
    :meth:`columns`. Effects of users outside the project are found by their import path, as those of the chain are.

    Attributes
    ----------
    weights : tuple of float
        One for each column, in the units of :meth:`units`; empty while they are unknown.
    """

    place = "joint"
    #: Signals of which it is tried as an explanation.
    explains: ClassVar[tuple[str, ...]] = ("current",)
    #: Signals that the columns are made of.
    needs: ClassVar[tuple[str, ...]] = ("omega",)

    weights: tuple[float, ...] = ()

    @abstractmethod
    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The columns of a recording."""

    @abstractmethod
    def units(self, of: str) -> tuple[str, ...]:
        """Of the weights, if the effect adds to a signal in the unit ``of``: one each, or one for all of them."""

    def signal(self, recording: JointRecording) -> Float[np.ndarray, " time"]:
        """What it adds, in the unit of the signal that it was fitted to."""
        return self.columns(recording) @ np.array(self.weights)

    @property
    def sound(self) -> bool:
        """Whether the weights have the sign that the physics demands."""
        return True

    def weighted(self, weights: np.ndarray) -> "Term":
        """The effect with its weights."""
        return replace(self, weights=tuple(np.asarray(weights, float).tolist()))

    @classmethod
    def possible(cls, recording: JointRecording) -> bool:
        """Whether a recording holds all that the columns are made of."""
        return all(name in recording.signals for name in cls.needs)
