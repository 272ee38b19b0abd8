"""Gears drawn from declared distributions, for questions that three gears cannot answer."""

from dataclasses import dataclass, replace

import numpy as np

from swgsim.common.checks import require, require_integer, require_range
from swgsim.common.seeds import generator
from swgsim.gear.gear import Gear


@dataclass(frozen=True)
class Population:
    """Spread of a population of gears around a nominal one.

    Attributes
    ----------
    count : int
        Number of gears.
    b1_ratio, k1_ratio : (low, high)
        Factors on b1 and k1, drawn evenly; 0.8 to 1.2 is the range of Table IV.
    b0_ratio, mu_ratio, w0_ratio : (low, high)
        Factors on dry friction, Coulomb friction and the deflection, drawn evenly; the paper's gears share them.
    gain, offset, position, grid_angle : float
        Standard deviations of the gauge errors [-, mV/V, rad, rad].
    kinematic_error : (low, high)
        Factor on each amplitude of the kinematic error, whose phases are drawn evenly.
    """

    count: int
    b1_ratio: tuple[float, float] = (0.8, 1.2)
    k1_ratio: tuple[float, float] = (0.8, 1.2)
    b0_ratio: tuple[float, float] = (1.0, 1.0)
    mu_ratio: tuple[float, float] = (1.0, 1.0)
    w0_ratio: tuple[float, float] = (1.0, 1.0)
    gain: float = 0.005
    offset: float = 0.004
    position: float = 0.005
    grid_angle: float = 0.005
    kinematic_error: tuple[float, float] = (0.5, 1.5)

    def __post_init__(self) -> None:
        require_integer("the population", "count", self.count, low=1, high=100_000)
        for name in ("b1_ratio", "k1_ratio", "b0_ratio", "mu_ratio", "w0_ratio", "kinematic_error"):
            require_range("the population", name, getattr(self, name), low=0.1, high=10)
        for name in ("gain", "offset", "position", "grid_angle"):
            require("the population", name, getattr(self, name), low=0, high=0.2)

    def draw(self, nominal: Gear, seed: int) -> tuple[Gear, ...]:
        """The gears, numbered from 1; adding gears does not change the first ones."""
        return tuple(self._one(nominal, number, seed) for number in range(1, self.count + 1))

    def _one(self, nominal: Gear, number: int, seed: int) -> Gear:
        rng = generator("gear", seed, number)
        t, gauges = nominal.transmission, nominal.gauges
        error = tuple(
            replace(
                term,
                amplitude=term.amplitude * rng.uniform(*self.kinematic_error),
                phase=rng.uniform(0, 2 * np.pi),
            )
            for term in t.kinematic_error
        )
        transmission = replace(
            t, b1=t.b1 * rng.uniform(*self.b1_ratio), k1=t.k1 * rng.uniform(*self.k1_ratio), kinematic_error=error
        )
        gauges = replace(
            gauges,
            gain=tuple(rng.normal(1, self.gain, 5)),
            offset=tuple(rng.normal(0, self.offset, 5)),
            position=tuple(rng.normal(0, self.position, 5)),
            grid_angle=tuple(rng.normal(0, self.grid_angle, 5)),
        )
        rng = generator("friction and deflection of a gear", seed, number)
        transmission = replace(
            transmission, b0=t.b0 * rng.uniform(*self.b0_ratio), mu=t.mu * rng.uniform(*self.mu_ratio)
        )
        w0 = nominal.wave_generator.w0 * rng.uniform(*self.w0_ratio)
        wave_generator = replace(nominal.wave_generator, w0=w0)
        return replace(nominal, number=number, transmission=transmission, wave_generator=wave_generator, gauges=gauges)
