"""A regularity without a known cause, as an effect: one order, one pattern over the channels, one law."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex

from swgsim.common.checks import require_known
from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.frozen import FULL_LOAD, FULL_SPEED
from swgsim.effects.quantity import choice, phase, size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint

# Gauges s1 to s4 sit a quarter turn apart; a pattern of m waves travels around them.
PATTERNS: Mapping[str, Mapping[str, complex]] = {
    "the same in s1 to s4": dict.fromkeys(("s1", "s2", "s3", "s4"), 1),
    "the same in all gauges": dict.fromkeys(("s0", "s1", "s2", "s3", "s4"), 1),
    "opposite in neighbours (two waves)": {"s1": 1, "s2": -1, "s3": 1, "s4": -1},
    "one wave that turns with the wave generator (or three against it)": {"s1": 1, "s2": -1j, "s3": -1, "s4": 1j},
    "one wave that turns against the wave generator (or three with it)": {"s1": 1, "s2": 1j, "s3": -1, "s4": -1j},
    "opposite in s1 and s3": {"s1": 1, "s3": -1},
    "opposite in s2 and s4": {"s2": 1, "s4": -1},
    **{f"in {name} alone": {name: 1} for name in ("s0", "s1", "s2", "s3", "s4", "T_in", "T_out", "n_in")},
}
# Laws of quantities that rise together during one session, and otherwise in another.
OF_TEMPERATURE, OF_TIME = (
    "proportional to the temperature above 25 degC",
    "proportional to the time since the session began",
)
KELVIN, HOUR = 10.0, 3600.0
# Highest order; with 64 samples per revolution a model would alias a higher one to an order below 13.
HIGHEST_ORDER = 50
# Simple ones first.
LAWS: Mapping[str, Callable[[OperatingPoint, Conditions], float]] = {
    "constant": lambda point, _: 1.0,
    "proportional to the load": lambda point, _: point.T_out / FULL_LOAD,
    "with the square of the load": lambda point, _: (point.T_out / FULL_LOAD) ** 2,
    "with the root of the load": lambda point, _: (point.T_out / FULL_LOAD) ** 0.5,
    "proportional to the speed": lambda point, _: point.n_in_rpm / FULL_SPEED,
    "with the square of the speed": lambda point, _: (point.n_in_rpm / FULL_SPEED) ** 2,
    "proportional to load and speed": lambda point, _: point.T_out / FULL_LOAD * point.n_in_rpm / FULL_SPEED,
    OF_TEMPERATURE: lambda _, conditions: conditions.warmer / KELVIN,
    OF_TIME: lambda _, conditions: conditions.elapsed / HOUR,
}


@dataclass(frozen=True)
class Regularity(Effect):
    """One order of the wave generator on the recorded channels, with one pattern and one law, without a known cause.

    The identification adds it where no effect of the library fits. It predicts signals but names no cause.

    Signature: as the parameters say. Typical: one hundredth of order 2.

    Attributes
    ----------
    order : int
        Of the wave generator's revolution, from 0 (the mean) to 50.
    amplitude : float
        At 70 N m, 4000 rpm, 10 K above 25 degC or after 1 h, as the law needs them; in the unit of the channels, from
        -100 to 100.
    phase : float
        Of cos(order phi_in - phase) [rad].
    pattern : str
        Of :data:`PATTERNS`.
    law : str
        Of :data:`LAWS`.
    """

    place = "acquisition"
    order: int = choice(low=0, high=HIGHEST_ORDER)
    amplitude: float = size(unit="-", low=-100, high=100, typical=1e-3)
    phase: float = phase()
    pattern: str = "the same in s1 to s4"
    law: str = "constant"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_known(f"pattern of {self.title()}", [self.pattern], PATTERNS)
        require_known(f"law of {self.title()}", [self.law], LAWS)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the order on those of the pattern."""
        amplitude = self.amplitude * LAWS[self.law](scene.point, scene.conditions)
        return with_wave(channels, self.pattern, amplitude * np.exp(1j * (self.order * scene.phi_in - self.phase)))


def with_wave(channels: Channels, pattern: str, turn: Complex[np.ndarray, " time"]) -> Channels:
    """The channels with a wave on those of a pattern."""
    return {**channels, **{name: channels[name] + (weight * turn).real for name, weight in PATTERNS[pattern].items()}}
