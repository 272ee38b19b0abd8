"""Base class of the effects on a joint: columns over time, each with a weight that least squares finds."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.joint.recording import OF_DRIVE, JointRecording


@dataclass(frozen=True, kw_only=True)
class Term(Effect, ABC):
    """Contribution of one physical effect to a signal of a joint.

    Declared parameters shape the columns; the weights scale them. A subclass implements :meth:`columns`. Effects from
    outside the project are found by their import path, as those of the chain are.

    Attributes
    ----------
    weights : tuple of float
        One for each column, in the units of :meth:`units`; empty while they are unknown.
    """

    place = "joint"
    #: Signals that the effect may explain.
    explains: ClassVar[tuple[str, ...]] = OF_DRIVE
    #: Signals that the columns need.
    needs: ClassVar[tuple[str, ...]] = ("omega",)
    #: Names of the weights.
    weight_names: ClassVar[tuple[str, ...]] = ()
    #: Units of the weights after the unit of the signal: one each, or one for all.
    per: ClassVar[tuple[str, ...]] = ("",)
    #: Whether all weights must be positive, because friction brakes.
    brakes: ClassVar[bool] = False
    #: Whether the effect corrects the rigid-body model, so that a measured load leaves it no meaning.
    of_model: ClassVar[bool] = False
    #: Whether the columns at one time depend on the inputs at all times of the recording.
    of_whole: ClassVar[bool] = False

    weights: tuple[float, ...] = ()

    @abstractmethod
    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The columns of a recording."""

    def names(self) -> tuple[str, ...]:
        """Names of the weights: as declared, or numbered if there are several."""
        number = len(self.weights)
        default = (self.name(),) if number == 1 else tuple(f"{self.name()} {i + 1}" for i in range(number))
        return self.weight_names or default

    def units(self, of: str) -> tuple[str, ...]:
        """Units of the weights for a signal in the unit ``of``: one each, or one for all."""
        return tuple(of + each for each in self.per)

    def signal(self, recording: JointRecording) -> Float[np.ndarray, " time"]:
        """Contribution in the unit of the fitted signal."""
        return self.columns(recording) @ np.array(self.weights)

    def least(self, columns: int) -> Float[np.ndarray, " column"]:
        """Smallest possible weight of each column: 0 or minus infinity."""
        return np.full(columns, -np.inf)

    def added_to(self, terms: Sequence["Term"]) -> Any:
        """The effect with what it shares with the terms of a model, to which it is added."""
        return self

    @property
    def has_physical_sign(self) -> bool:
        """Whether the weights have the sign that physics requires."""
        return not self.brakes or all(weight > 0 for weight in self.weights)

    def weighted(self, weights: np.ndarray) -> "Term":
        """The effect with its weights."""
        return replace(self, weights=tuple(np.asarray(weights, float).tolist()))

    def possible(self, recording: JointRecording) -> bool:
        """Whether a recording has all signals that the columns need."""
        return all(name in recording.signals for name in self.needs)
