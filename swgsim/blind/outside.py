"""Effects that are in no library, written for the blind test; each says what an observer should say of it.

They stand for things that happen to test benches without a textbook entry. Their form is deliberately plain, one order
with one pattern over the channels and one law, as only then an open description can be called right or wrong. Half of
them resemble an effect of the library.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import phase, size
from swgsim.effects.regularity import LAWS, OF_TEMPERATURE, OF_TIME, with_wave
from swgsim.identification.search.regularities import Atom


@dataclass(frozen=True)
class Outside(Effect):
    """One order on the channels, by a pattern and a law.

    Attributes
    ----------
    amplitude : float
        [mV/V] for gauges, [N m] for torques; at full load and speed, 10 K, 1 h where the law has them.
    phase : float
        [rad]; of no account for a mean.
    """

    place = "acquisition"
    described: ClassVar[Atom]
    amplitude: float = size(unit="-", low=0, high=0.2, typical=1e-3)
    phase: float = phase()

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the order on those of the pattern."""
        atom = self.described
        amplitude = self.amplitude * LAWS[atom.law](scene.point, scene.conditions)
        angle = atom.order * scene.phi_in + self.phase * (atom.order > 0)
        return with_wave(channels, atom.pattern, amplitude * np.exp(1j * angle))


class WhippingCable(Outside):
    """The cable of one gauge is dragged along once per revolution, the harder the faster."""

    described = Atom(1, "in s4 alone", "proportional to the speed")


class HummingClamp(Outside):
    """The clamp of the collar shrinks and widens five times per revolution under load and speed."""

    described = Atom(5, "the same in s1 to s4", "proportional to load and speed")


class WobblingSeal(Outside):
    """A seal drives a wave around the collar with the wave generator, three to a revolution, by inertia."""

    described = Atom(
        3, "one wave that turns with the wave generator (or three against it)", "with the square of the speed"
    )


class ChatteringBrake(Outside):
    """The brake at the input touches seven times per revolution; only the flange there feels it."""

    described = Atom(7, "in T_in alone", "proportional to the speed")


class LooseSolder(Outside):
    """A joint of one bridge gives way under load; it resembles a zero or a gain of that bridge."""

    described = Atom(0, "in s2 alone", "with the root of the load")


class LeaningHousing(Outside):
    """The housing leans under load more and more; it resembles a tilting moment."""

    described = Atom(0, "opposite in s1 and s3", "with the square of the load")


class BreathingBand(Outside):
    """The toothed band grows with heat and is pressed flat by the lobes; it resembles a wave generator that grows."""

    described = Atom(2, "opposite in neighbours (two waves)", OF_TEMPERATURE)


class TiringBelt(Outside):
    """The belt of the load goes slack during the session and pulls at all gauges; it resembles a torque ripple."""

    described = Atom(4, "the same in s1 to s4", OF_TIME)


OUTSIDE: tuple[type[Outside], ...] = (
    WhippingCable, HummingClamp, WobblingSeal, ChatteringBrake, LooseSolder, LeaningHousing, BreathingBand, TiringBelt,
)  # fmt: skip
