"""What can be hidden: each effect makes another unit of a healthy one."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace

import numpy as np
from jaxtyping import Float

from other_bench.specimen import Crack, Specimen


@dataclass(frozen=True)
class Drawn:
    """What an effect leaves to chance.

    Attributes
    ----------
    theta, phase : float
        Direction or place, and phase [rad].
    channel : int
        Of s1 to s4.
    """

    theta: float
    phase: float
    channel: int

    @classmethod
    def of(cls, rng: np.random.Generator) -> "Drawn":
        """Drawn evenly."""
        theta, phase = (float(rng.uniform(0, 2 * np.pi)) for _ in range(2))
        return cls(theta, phase, int(rng.integers(1, 5)))

    @property
    def own(self) -> Float[np.ndarray, " gauge"]:
        """1 for the channel."""
        return np.eye(5)[self.channel]


@dataclass(frozen=True)
class Kind:
    """One effect.

    Attributes
    ----------
    size : float
        Default.
    unit, what : str
        Of the size.
    changed : callable
        The unit with an effect of a size, from the healthy one.
    uses : tuple of str
        Of what is drawn.
    """

    size: float
    unit: str
    what: str
    changed: Callable[[Specimen, float, Drawn], Specimen]
    uses: tuple[str, ...] = ()


@dataclass(frozen=True)
class Effect:
    """An effect of some size, or `none`."""

    name: str
    size: float
    drawn: Drawn

    def on(self, healthy: Specimen) -> Specimen:
        """The unit that has it."""
        return EFFECTS[self.name].changed(healthy, self.size, self.drawn)

    @property
    def truth(self) -> dict[str, object]:
        """All there is to know of it."""
        kind, drawn = EFFECTS[self.name], asdict(self.drawn)
        named = {"name": self.name, "size": self.size, "unit_of_size": kind.unit, "what": kind.what}
        return {**named, **{key: drawn[key] for key in kind.uses}}


def _turned(size: float, angle: float) -> complex:
    return complex(size * np.exp(1j * angle))


EFFECTS: Mapping[str, Kind] = {
    "none": Kind(0.0, "-", "nothing", lambda unit, x, drawn: unit),
    "eccentric_wave_generator": Kind(
        15e-6, "m", "static offset of the wave generator",
        lambda unit, x, drawn: replace(unit, eccentricity=_turned(x, drawn.theta)), ("theta",),
    ),
    "reduced_damping": Kind(
        0.2, "-", "share of b1 lost", lambda unit, x, drawn: replace(unit, b1=unit.b1 * (1 - x))
    ),
    "reduced_stiffness": Kind(
        0.1, "-", "share of k1 lost", lambda unit, x, drawn: replace(unit, k1=unit.k1 * (1 - x))
    ),
    "root_tooth_crack": Kind(
        0.9, "-", "share of hoop stiffness lost over three tooth pitches",
        lambda unit, x, drawn: replace(unit, root=Crack(x, drawn.theta)), ("theta",),
    ),
    "tip_tooth_crack": Kind(
        0.8, "-", "share of tooth force lost over four teeth",
        lambda unit, x, drawn: replace(unit, tip=Crack(x, drawn.theta)), ("theta",),
    ),
    "gauge_gain": Kind(
        0.03, "-", "of s2", lambda unit, x, drawn: replace(unit, gain=unit.gain * (1 + x * np.eye(5)[2]))
    ),
    "gauge_position": Kind(
        0.01, "rad", "of s3", lambda unit, x, drawn: replace(unit, position=unit.position + x * np.eye(4)[2])
    ),
    "mains_hum": Kind(
        3e-4, "mV/V", "50 Hz on one of s1 to s4", lambda unit, x, drawn: replace(unit, hum=x * drawn.own), ("channel",)
    ),
    "flank_friction": Kind(
        0.3, "-", "mu grows by this share", lambda unit, x, drawn: replace(unit, mu=unit.mu * (1 + x))
    ),
    "kinematic_error_order": Kind(
        3e-5, "rad", "at the output, added to order 2",
        lambda unit, x, drawn: replace(unit, kinematic=unit.kinematic + _turned(x, drawn.phase) * np.eye(3)[1]),
        ("phase",),
    ),
    "tilting_moment": Kind(
        10.0, "N m", "on the output, turns with it; theta is its direction when the bench starts",
        lambda unit, x, drawn: replace(unit, moment=_turned(x, drawn.theta)), ("theta",),
    ),
    "zero_offset": Kind(
        0.01, "mV/V", "one of s1 to s4",
        lambda unit, x, drawn: replace(unit, offset=unit.offset + x * drawn.own), ("channel",),
    ),
    "sticky_bearing": Kind(
        0.05, "N m", "friction torque size |sin(phi_in / 3)| at the input",
        lambda unit, x, drawn: replace(unit, sticky=x),
    ),
    "breathing_case": Kind(
        1e-3, "mV/V", "at 70 N m, order 4, +s1 -s3, grows with the square of the load",
        lambda unit, x, drawn: replace(unit, breathing=_turned(x, drawn.phase)), ("phase",),
    ),
}  # fmt: skip
