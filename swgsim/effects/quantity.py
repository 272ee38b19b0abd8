"""Parameters of effects: unit, physical bounds, typical value, and the role in the identification."""

from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from enum import Enum
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np

from swgsim.common.checks import require, require_integer, require_one_of


class Role(Enum):
    """Role of a parameter in a search for the effect."""

    SIZE = "size"  # amount of the effect; at one value it changes nothing
    PHASE = "phase"  # of a wave: the amplitudes of cosine and sine give every phase
    ANGLE = "angle"  # a position around the circumference; a search tries several
    RANDOM = "random"  # a phase that differs in every recording
    SHAPE = "shape"  # a number that shapes the effect; a search may try several
    CHOICE = "choice"  # an integer, such as an order or a gauge, or one of a list


@dataclass(frozen=True)
class Quantity:
    """One parameter of an effect.

    Attributes
    ----------
    role : Role
    unit : str
        SI, "-" for a share.
    low, high : float
        Bounds; beyond, the model does not hold or the gear is broken in another way.
    typical : float
        Size in the literature, or the middle of the plausible range; of a choice, its default or lowest value.
    nothing : float
        Of a size: the value at which the effect changes nothing.
    points : int
        Number of values that a search tries, evenly from low to high; a choice tries all.
    among : tuple of float
        Of a choice: all its values; if empty, every integer from low to high.
    further : tuple of float
        Of a size: further values that a search tries, because their signatures have another shape.
    of_structure : bool
        Of a shape: a search keeps it typical unless the gear has another structure than the model.
    scale : float
        Of a size: signals are linear in it over a hundredth of this; infinite where they are linear over all its range.
    """

    role: Role
    unit: str
    low: float
    high: float
    typical: float
    nothing: float = 0.0
    points: int = 1
    among: tuple[float, ...] = ()
    further: tuple[float, ...] = ()
    of_structure: bool = False
    scale: float = np.inf

    def open(self, another_structure: bool) -> bool:
        """Whether a search may choose a value, for a gear of the model's structure or of another structure."""
        return self.points > 1 and (another_structure or not self.of_structure)

    def check(self, owner: str, name: str, value: Any) -> None:
        """Raise a ValueError unless the value is a number within the bounds, or one of the choices."""
        if self.among:
            require_one_of(owner, name, value, self.among)
        elif self.role is Role.CHOICE:
            require_integer(owner, name, value, int(self.low), int(self.high))
        elif self.role in (Role.PHASE, Role.ANGLE, Role.RANDOM):
            require(owner, name, value)
        else:
            require(owner, name, value, self.low, self.high)

    @property
    def tried(self) -> tuple[float, ...]:
        """The values that a search tries."""
        if self.role is Role.CHOICE:
            return self.among or tuple(range(int(self.low), int(self.high) + 1))
        if self.role is Role.ANGLE:
            return tuple((2 * np.pi * np.arange(self.points) / self.points).tolist())
        if self.role is Role.SHAPE and self.points > 1:
            return tuple(np.linspace(self.low, self.high, self.points).tolist())
        return self.typical, *self.further


def size(
    *,
    unit: str,
    low: float,
    high: float,
    typical: float,
    nothing: float = 0.0,
    further: tuple[float, ...] = (),
    scale: float = np.inf,
) -> Any:
    """Declare the size: the amount of the effect; every effect has one."""
    return _parameter(Quantity(Role.SIZE, unit, low, high, typical, nothing, further=further, scale=scale))


def phase() -> Any:
    """Declare the phase [rad] of a wave whose amplitude is the size."""
    return _parameter(Quantity(Role.PHASE, "rad", 0, 2 * np.pi, 0.0), 0.0)


def random_phase() -> Any:
    """Declare a phase [rad] that differs from recording to recording."""
    return _parameter(Quantity(Role.RANDOM, "rad", 0, 2 * np.pi, 0.0), 0.0)


def angle(*, points: int = 24) -> Any:
    """Declare a position around the circumference, from gauge s1 [rad]."""
    return _parameter(Quantity(Role.ANGLE, "rad", 0, 2 * np.pi, 0.0, points=points))


def shape(default: float, *, unit: str, low: float, high: float, points: int = 1, of_structure: bool = False) -> Any:
    """Declare a number that shapes the effect; its default is the typical value."""
    return _parameter(Quantity(Role.SHAPE, unit, low, high, default, points=points, of_structure=of_structure), default)


def choice(default: Any = MISSING, *, low: int, high: int) -> Any:
    """Declare an integer such as an order or the number of a gauge."""
    return _parameter(Quantity(Role.CHOICE, "-", low, high, low if default is MISSING else default), default)


def choice_among(*among: float, unit: str) -> Any:
    """Declare a choice from a list of values; the default is the first."""
    return _parameter(Quantity(Role.CHOICE, unit, min(among), max(among), among[0], among=among), among[0])


def quantities(kind: type) -> Mapping[str, Quantity]:
    """The parameters of a class of effects, in order."""
    return _declared(kind)


@cache  # not the function above, as mypy takes no class of effects for hashable
def _declared(kind: type) -> Mapping[str, Quantity]:
    return MappingProxyType({f.name: f.metadata["quantity"] for f in fields(kind) if "quantity" in f.metadata})


def size_of(kind: type) -> str:
    """Name of the parameter that is the size of an effect."""
    return next(name for name, quantity in quantities(kind).items() if quantity.role is Role.SIZE)


def beyond_nothing(effect: object) -> float:
    """Size of an effect minus the size that changes nothing, in its unit."""
    name = size_of(type(effect))
    return float(getattr(effect, name) - quantities(type(effect))[name].nothing)


def _parameter(quantity: Quantity, default: Any = MISSING) -> Field:
    return field(default=default, metadata={"quantity": quantity})
