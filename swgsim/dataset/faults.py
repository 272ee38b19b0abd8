"""The five fault classes of Table I as effects, and their variants: severities, positions, width of cracks."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from swgsim.common.checks import require_integer, require_known
from swgsim.effects import (
    EccentricWaveGenerator,
    Effect,
    ReducedDamping,
    ReducedStiffness,
    RootToothCrack,
    TipToothCrack,
)
from swgsim.effects.tip_tooth_crack import TOOTH
from swgsim.storage.labelled_signals import CLASSES

# The effect of each class (Table I) at a severity and a position from gauge s1 [rad].
FAULTS: Mapping[str, Callable[[float, float], Effect]] = {
    "reduced_damping": lambda severity, _: ReducedDamping(severity),
    "reduced_stiffness": lambda severity, _: ReducedStiffness(severity),
    "eccentric_wave_generator": EccentricWaveGenerator,
    "root_tooth_crack": RootToothCrack,
    "tip_tooth_crack": TipToothCrack,
}
WITHOUT_POSITION = ("reduced_damping", "reduced_stiffness")


def widened(effect: Effect, teeth: int | None) -> tuple[Effect, ...]:
    """A crack that takes several teeth of 200, as one at a node of a coarse truss does; others stay as they are.

    A tip crack takes the force of so many teeth; a root crack is one at each of them. None leaves both as they are:
    four teeth and one.

    >>> [round(each.theta / TOOTH, 1) for each in widened(RootToothCrack(0.1, 0.0), 3)]
    [-1.0, 0.0, 1.0]
    """
    if teeth and isinstance(effect, TipToothCrack):
        return (replace(effect, width=teeth * TOOTH),)
    if teeth and isinstance(effect, RootToothCrack):
        return tuple(replace(effect, theta=effect.theta + TOOTH * (n - (teeth - 1) / 2)) for n in range(teeth))
    return (effect,)


@dataclass(frozen=True)
class Variant:
    """One variant of a class.

    Attributes
    ----------
    label : str
    number : int
    severity : float
        Size of the effect in its unit; NaN when healthy.
    position : float
        Angle around the flex spline, from gauge s1 [rad]; NaN for classes without one.
    effects : tuple of Effect
    """

    label: str
    number: int
    severity: float
    position: float
    effects: tuple[Effect, ...]


@dataclass(frozen=True)
class Variants:
    """Severities and positions of the variants of every class (Table V).

    Attributes
    ----------
    count : int
        Variants per class.
    positions : int
        Number of equally spaced positions; times the number of severities it must equal ``count``.
    severities : mapping
        Severities of each class. Classes without a position have ``count`` even values from the first to the last.
    drawn : bool
        Whether severities (between the extremes) and positions are drawn continuously instead.
    crack_teeth : int or None
        Teeth that a crack takes, from 1 to 10; None for those of its effect (:func:`widened`).
    """

    count: int
    positions: int
    severities: Mapping[str, tuple[float, ...]]
    drawn: bool = False
    crack_teeth: int | None = None

    def __post_init__(self) -> None:
        require_integer("the grid", "variants", self.count, low=1, high=1_000_000)
        require_integer("the grid", "positions", self.positions, low=1, high=100_000)
        if self.crack_teeth is not None:
            require_integer("the grid", "crack_teeth", self.crack_teeth, low=1, high=10)
        if not isinstance(self.drawn, bool):
            raise ValueError(f"drawn of the grid is {self.drawn!r}, must be true or false")
        unknown = set(self.severities) ^ set(FAULTS)
        if unknown:
            raise ValueError(
                f"severities for {sorted(self.severities)}, expected one list for each of {sorted(FAULTS)}"
            )
        for label, levels in self.severities.items():
            if not levels:
                raise ValueError(f"{label}: no severities, give at least one")
            for level in levels:
                FAULTS[label](level, 0.0)
            located = label not in WITHOUT_POSITION
            if located and not self.drawn and len(levels) * self.positions != self.count:
                raise ValueError(
                    f"{label}: {len(levels)} severities x {self.positions} positions do not make {self.count} variants"
                )

    def of(self, label: str, rng: np.random.Generator) -> Iterator[Variant]:
        """The variants of one class; ``rng`` is used only if they are drawn.

        Raises
        ------
        ValueError
            If the class is unknown; the message lists the classes.
        """
        require_known("the classes", [label], CLASSES)
        for number in range(self.count):
            if label == "healthy":
                yield Variant(label, number, np.nan, np.nan, ())
                continue
            levels = self.severities[label]
            located = label not in WITHOUT_POSITION
            if self.drawn:
                severity, position = rng.uniform(min(levels), max(levels)), rng.uniform(0, 2 * np.pi)
            elif located:
                severity = levels[number // self.positions]
                position = 2 * np.pi * (number % self.positions) / self.positions
            else:
                severity, position = np.linspace(levels[0], levels[-1], self.count)[number], np.nan
            effects = widened(FAULTS[label](float(severity), float(position)), self.crack_teeth)
            yield Variant(label, number, float(severity), float(position) if located else np.nan, effects)
