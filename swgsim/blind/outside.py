"""Effects that are in no library, written for the blind test; each says what an observer should say of it.

They stand for things that happen to test benches without a textbook entry. Their form is deliberately plain, one order
with one pattern over the gauges and one law, as only then an open description can be called right or wrong. Half of
them resemble an effect of the library.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD, FULL_SPEED
from swgsim.effects.quantity import phase, size
from swgsim.identification.search.regularities import Atom

# Places of s1 to s4 around the collar [rad].
PLACES = np.array([0.0, 0.5, 1.0, 1.5]) * np.pi


@dataclass(frozen=True)
class Outside(Effect):
    """One order on the channels, larger or smaller by some law.

    Attributes
    ----------
    amplitude : float
        [mV/V] for gauges, [N m] for torques; at full load and speed, 10 K, 1 h where the law has them.
    phase : float
        [rad].
    """

    place = "acquisition"
    described: ClassVar[Atom]
    amplitude: float = size(unit="-", low=0, high=0.2, typical=1e-3)
    phase: float = phase()

    def law(self, scene: Scene) -> float:
        """Size in one recording."""
        return 1.0

    def pattern(self) -> Mapping[str, float]:
        """Phase of every channel that has it [rad]."""
        return {}

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the order on them."""
        size, order = self.amplitude * self.law(scene), self.described.order
        waves = {
            name: channels[name] + size * np.cos(order * scene.phi_in + self.phase * (order > 0) + angle)
            for name, angle in self.pattern().items()
        }
        return {**channels, **waves}


def _alike() -> dict[str, float]:
    return dict.fromkeys(("s1", "s2", "s3", "s4"), 0.0)


@dataclass(frozen=True)
class WhippingCable(Outside):
    """The cable of one gauge is dragged along once per revolution, the harder the faster."""

    described = Atom(1, "in s4 alone", "proportional to the speed")

    def law(self, scene: Scene) -> float:
        """Proportional to the speed."""
        return scene.point.n_in_rpm / FULL_SPEED

    def pattern(self) -> Mapping[str, float]:
        """One gauge."""
        return {"s4": 0.0}


@dataclass(frozen=True)
class HummingClamp(Outside):
    """The clamp of the collar shrinks and widens five times per revolution under load and speed."""

    described = Atom(5, "the same in s1 to s4", "proportional to load and speed")

    def law(self, scene: Scene) -> float:
        """Proportional to both."""
        return scene.point.n_in_rpm / FULL_SPEED * scene.point.T_out / FULL_LOAD

    def pattern(self) -> Mapping[str, float]:
        """All four."""
        return _alike()


@dataclass(frozen=True)
class WobblingSeal(Outside):
    """A seal drives a wave around the collar with the wave generator, three to a revolution, by inertia."""

    described = Atom(
        3, "one wave that turns with the wave generator (or three against it)", "with the square of the speed"
    )

    def law(self, scene: Scene) -> float:
        """As inertia goes."""
        return (scene.point.n_in_rpm / FULL_SPEED) ** 2

    def pattern(self) -> Mapping[str, float]:
        """A quarter of a turn later from gauge to gauge."""
        return {f"s{i + 1}": -float(angle) for i, angle in enumerate(PLACES)}


@dataclass(frozen=True)
class ChatteringBrake(Outside):
    """The brake at the input touches seven times per revolution; only the flange there feels it."""

    described = Atom(7, "in T_in alone", "proportional to the speed")

    def law(self, scene: Scene) -> float:
        """Proportional to the speed."""
        return scene.point.n_in_rpm / FULL_SPEED

    def pattern(self) -> Mapping[str, float]:
        """The flange at the input."""
        return {"T_in": 0.0}


@dataclass(frozen=True)
class LooseSolder(Outside):
    """A joint of one bridge gives way under load; it resembles a zero or a gain of that bridge."""

    described = Atom(0, "in s2 alone", "with the root of the load")

    def law(self, scene: Scene) -> float:
        """With the root of the load."""
        return float(np.sqrt(scene.point.T_out / FULL_LOAD))

    def pattern(self) -> Mapping[str, float]:
        """One gauge."""
        return {"s2": 0.0}


@dataclass(frozen=True)
class LeaningHousing(Outside):
    """The housing leans under load more and more; it resembles a tilting moment."""

    described = Atom(0, "opposite in s1 and s3", "with the square of the load")

    def law(self, scene: Scene) -> float:
        """With the square of the load."""
        return (scene.point.T_out / FULL_LOAD) ** 2

    def pattern(self) -> Mapping[str, float]:
        """Two opposite gauges, one of them the other way."""
        return {"s1": 0.0, "s3": np.pi}


@dataclass(frozen=True)
class BreathingBand(Outside):
    """The toothed band grows with heat and is pressed flat by the lobes; it resembles a wave generator that grows."""

    described = Atom(2, "opposite in neighbours (two waves)", "proportional to the temperature above 25 degC")

    def law(self, scene: Scene) -> float:
        """Proportional to the temperature."""
        return scene.conditions.warmer / 10.0

    def pattern(self) -> Mapping[str, float]:
        """Two waves around the collar."""
        return {f"s{i + 1}": 2 * float(angle) for i, angle in enumerate(PLACES)}


@dataclass(frozen=True)
class TiringBelt(Outside):
    """The belt of the load goes slack during the session and pulls at all gauges; it resembles a torque ripple."""

    described = Atom(4, "the same in s1 to s4", "proportional to the time since the session began")

    def law(self, scene: Scene) -> float:
        """Proportional to the time."""
        return scene.conditions.elapsed / 3600.0

    def pattern(self) -> Mapping[str, float]:
        """All four."""
        return _alike()


OUTSIDE: tuple[type[Outside], ...] = (
    WhippingCable, HummingClamp, WobblingSeal, ChatteringBrake, LooseSolder, LeaningHousing, BreathingBand, TiringBelt,
)  # fmt: skip
