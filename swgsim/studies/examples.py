"""One example of each fault for figures and claims: the severest of conf/grid/paper."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import pi

import numpy as np
from jaxtyping import Float

from swgsim.chain.chain import SECTORS, Run, Simulation, simulate
from swgsim.dataset.faults import FAULTS, widened
from swgsim.dataset.plan import Plan
from swgsim.effects import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint

# Severity and position [rad]. The eccentricity points to s2, where it shears the collar at s1 and s3; the root crack
# lies between s1 and s2, the cracked tip at s1.
SEVEREST: Mapping[str, tuple[float, float]] = {
    "reduced_damping": (2 / 3, 0.0),
    "reduced_stiffness": (0.8, 0.0),
    "eccentric_wave_generator": (100e-6, pi / 2),
    "root_tooth_crack": (0.01, pi / 4),
    "tip_tooth_crack": (1.0, 0.0),
}
EXAMPLES: Mapping[str, Effect] = {label: FAULTS[label](*size) for label, size in SEVEREST.items()}

# The paper's six operating points (section III-B).
PAPER_POINTS = tuple(OperatingPoint(n, T) for n in (2000, 4000) for T in (7, 39, 70))

# The paper does not say at which operating point its figures are; the tooth forces show best at full load.
FIGURE_POINT = OperatingPoint(2000, 70)


@dataclass(frozen=True)
class Subject:
    """Gears and operating points on which claims are tested.

    Attributes
    ----------
    gears : tuple of Gear
        The first one is used where one is enough.
    points : tuple of OperatingPoint
        The paper's by default, whatever grid the data set has.
    window : Window
    sectors : int
    crack_teeth : int or None
        Teeth that a crack takes, as in :func:`~swgsim.dataset.faults.widened`.
    effects : tuple of Effect
        Physics of the healthy gear and of the faulty one alike.
    """

    gears: tuple[Gear, ...]
    points: tuple[OperatingPoint, ...] = PAPER_POINTS
    window: Window = field(default_factory=Window)
    sectors: int = SECTORS
    crack_teeth: int | None = None
    effects: tuple[Effect, ...] = ()

    @classmethod
    def of(cls, plan: Plan) -> "Subject":
        """Gears, window, mesh, cracks and declared effects of a data set."""
        teeth = plan.grid.variants.crack_teeth
        return cls(plan.gears, window=plan.window, sectors=plan.sectors, crack_teeth=teeth, effects=plan.effects)

    def simulate(self, *effects: Effect) -> Simulation:
        """The first gear with some effects at all operating points."""
        runs = [Run(self.gears[0], point, (*self.effects, *effects)) for point in self.points]
        return simulate(runs, self.window, self.sectors)

    def variants(self, effects: Sequence[Effect]) -> Float[np.ndarray, "effect 5 time"]:
        """Signals of the first gear with one effect after the other at the figures' operating point [mV/V]."""
        faults = [(*self.effects, *widened(effect, self.crack_teeth)) for effect in effects]
        runs = [Run(self.gears[0], FIGURE_POINT, fault) for fault in faults]
        return simulate(runs, self.window, self.sectors).signals

    @cached_property
    def healthy(self) -> Simulation:
        """The first gear without any effect at all operating points."""
        return self.simulate()

    @cached_property
    def examples(self) -> Mapping[str, Float[np.ndarray, "5 time"]]:
        """Signals [mV/V] of the healthy gear and of every example fault at the figures' operating point."""
        healthy = simulate([Run(self.gears[0], FIGURE_POINT, self.effects)], self.window, self.sectors).signals
        return {"healthy": healthy[0], **dict(zip(EXAMPLES, self.variants(tuple(EXAMPLES.values())), strict=True))}
