"""Grids: combinations of gears, fault variants and operating points."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from swgsim.chain.chain import Run
from swgsim.common.checks import require, require_integer, require_known
from swgsim.common.seeds import generator, seed_hash
from swgsim.dataset.faults import Variant, Variants
from swgsim.effects import ParameterScatter
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.storage.labelled_signals import CLASSES


@dataclass(frozen=True)
class Case:
    """One planned recording.

    Attributes
    ----------
    run : Run
    variant : Variant
    reference : bool
        Whether it is a reference recording of the gear.
    seed : int
        Seed of every random draw of this recording.
    day : int
        Of the recording, from 0; on each day the torque flanges have other biases.
    """

    run: Run
    variant: Variant
    reference: bool
    seed: int
    day: int = 0


@dataclass(frozen=True)
class Grid:
    """The grid of a data set.

    Attributes
    ----------
    points : tuple of OperatingPoint
    variants : Variants
    classes : tuple of str
    references : int
        Healthy reference acquisitions per gear and operating point.
    scatter : float
        Relative standard deviation of b1 and k1 between recordings; 0 in the paper's grid, where all healthy
        recordings of a gear are equal.
    seed : int
    days : int
        On which every specimen is recorded at all operating points; references are from a day of their own.
    """

    points: tuple[OperatingPoint, ...]
    variants: Variants
    classes: tuple[str, ...] = CLASSES
    references: int = 20
    scatter: float = 0.0
    seed: int = 0
    days: int = 1

    def __post_init__(self) -> None:
        if not self.points or not self.classes:
            raise ValueError(f"{len(self.points)} operating points x {len(self.classes)} classes: the grid is empty")
        require_known("the classes", self.classes, CLASSES)
        for name, values in (("operating points", self.points), ("classes", self.classes)):
            if len(set(values)) < len(values):
                raise ValueError(f"{name} of the grid repeat: {values}; name each once")
        require_integer("the grid", "references", self.references, low=1, high=10_000)
        require_integer("the grid", "seed", self.seed, low=0, high=2**63)
        require_integer("the grid", "days", self.days, low=1, high=1000)
        require("the grid", "scatter", self.scatter, low=0, high=0.05)

    def cases(self, gear: Gear) -> Iterator[Case]:
        """All planned recordings of one gear: the references, then class by class."""
        healthy = Variant("healthy", 0, np.nan, np.nan, ())
        for number in range(self.references):
            yield from self.of_specimen(gear, healthy, number, reference=True)
        for label in self.classes:
            for variant in self.variants.of(label, generator("variants", self.seed, gear.number, label)):
                for day in range(self.days):
                    yield from self.of_specimen(gear, variant, variant.number, day=day)

    def count(self) -> int:
        """Recordings per gear."""
        return len(self.points) * (self.references + len(self.classes) * self.variants.count * self.days)

    def of_specimen(
        self, gear: Gear, variant: Variant, number: int, *, reference: bool = False, day: int = 0
    ) -> Iterator[Case]:
        """The planned recordings of one specimen on a day, one at every operating point; ``number`` seeds them."""
        # The first day has the recordings of a grid of one day.
        further = (day,) if day else ()
        for point in self.points:
            kind = "reference" if reference else variant.label
            seed = seed_hash("recording", self.seed, gear.number, kind, number, point.n_in_rpm, point.T_out, *further)
            effects = variant.effects
            if self.scatter:
                b1_ratio, k1_ratio = np.clip(generator("scatter", seed).normal(1, self.scatter, 2), 0.8, 1.2)
                effects = (*effects, ParameterScatter(float(b1_ratio), float(k1_ratio)))
            yield Case(Run(gear, point, effects), variant, reference, seed, day)
