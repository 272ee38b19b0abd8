"""Signature of an effect: the change of order lines by an effect of typical size."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Complex, Float

from swgsim.chain.chain import SECTORS, Run, simulate_turns
from swgsim.effects.base import Effect
from swgsim.effects.kinematic_error_order import KinematicErrorOrder
from swgsim.effects.lost_motion import LostMotion
from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import PATTERNS
from swgsim.effects.stribeck_friction import StribeckFriction
from swgsim.effects.text import in_words
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.storage.labelled_signals import SENSORS

# Warm and late, so that effects of temperature and time show.
CONDITIONS = Conditions(temperature=35.0, elapsed=3600.0)
SHOWN_CHANNELS = ("n_in", "T_in", "T_out", *SENSORS)
REVOLUTIONS, SAMPLES, ORDERS = 12, 64, 12
# Changes below this share of a channel's largest line are rounding.
ROUNDING_SHARE = 1e-6
# A pattern over the gauges is named where it has this share of the line's power. Of what a torque changes, "the same in
# all gauges" has 0.86 to 0.9, as s0 shows twice as much as the others.
OWN = 0.85


@dataclass(frozen=True)
class Setting:
    """Operating point at which the signature of an effect is computed.

    Attributes
    ----------
    point : OperatingPoint
    beside : tuple of Effect
        Effects that act in both runs, with the effect and without it.
    reason : str
        Reason for another setting than the usual one.
    """

    point: OperatingPoint
    beside: tuple[Effect, ...] = ()
    reason: str = ""

    @property
    def points(self) -> tuple[OperatingPoint, OperatingPoint, OperatingPoint]:
        """The point, a tenth of its load, and twice its speed."""
        n, T = self.point.n_in_rpm, self.point.T_out
        return self.point, OperatingPoint(n, T / 10), OperatingPoint(2 * n, T)

    def __str__(self) -> str:
        beside = "".join(f", with {in_words(effect)}" for effect in self.beside)
        return f"{self.point.n_in_rpm:g} rpm, {self.point.T_out:g} N m{beside}"


USUAL = Setting(OperatingPoint(2000, 70))
# Effects that change nothing at the usual setting.
OTHER_SETTINGS: Mapping[type[Effect], Setting] = {
    LostMotion: Setting(
        OperatingPoint(750, 0.7),
        (KinematicErrorOrder(2, 1e-4),),
        "a load keeps the flanks together; with hardly any, a ripple of order 2 near the resonance parts them",
    ),
    StribeckFriction: Setting(
        OperatingPoint(200, 70),
        reason="at 2000 rpm the flanks slide on a full film of grease",
    ),
}


@dataclass(frozen=True, eq=False)
class Signature:
    """Change of order lines by an effect of typical size.

    Attributes
    ----------
    kind : type of Effect
    change : array (point, channel, line)
        At the points of the setting, for the channels SHOWN, at twelfths of an order [unit of the channel].
    largest_line : array (point, channel)
        Largest line other than the mean, without the effect.
    """

    kind: type[Effect]
    change: Complex[np.ndarray, "3 channel line"]
    largest_line: Float[np.ndarray, "3 channel"]

    def __post_init__(self) -> None:
        if self.top[0] < ROUNDING_SHARE:
            raise ValueError(
                f"{self.kind.name()} changes nothing at {self.setting} (at most {self.top[0]:.1e} of a channel's "
                f"largest line, must be {ROUNDING_SHARE:g}), so its picture would be empty; give it a setting in "
                "OTHER_SETTINGS"
            )

    @property
    def setting(self) -> Setting:
        """Operating point of the signature."""
        return OTHER_SETTINGS.get(self.kind, USUAL)

    @cached_property
    def share(self) -> Float[np.ndarray, "3 channel line"]:
        """Size of the change, as a share of the channel's largest line."""
        return np.abs(self.change) / self.largest_line[..., None]

    @property
    def where(self) -> tuple[int, int]:
        """Channel and line of the largest change."""
        channel, line = np.unravel_index(self.share[0].argmax(), self.share[0].shape)
        return int(channel), int(line)

    @property
    def top(self) -> Float[np.ndarray, "3"]:
        """The largest change at the three points."""
        return self.share[:, *self.where]

    @property
    def growth(self) -> tuple[str, str]:
        """Factors of growth with ten times the load and with twice the speed."""
        shown, light, fast = np.abs(self.change[:, *self.where])
        visible = self.top > ROUNDING_SHARE
        return f"{shown / light:.2g}" if visible[1] else "-", f"{fast / shown:.2g}" if visible[2] else "0"

    @property
    def over_gauges(self) -> str:
        """Order and pattern of the largest change of a gauge."""
        gauges = slice(-len(SENSORS), None)
        if self.share[0, gauges].max() < ROUNDING_SHARE:
            return "-"
        lines = self.change[0, gauges]
        line = int(np.abs(lines).max(axis=0).argmax())
        return f"order {line / REVOLUTIONS:.3g}: {pattern(lines[:, line])}"


def pattern(line: Complex[np.ndarray, " sensor"]) -> str:
    """Name of the pattern of one line over all gauges."""
    shares = {}
    for name, weights in PATTERNS.items():
        wave = np.array([weights.get(sensor, 0) for sensor in SENSORS])
        if wave.any():
            shares[name] = np.abs(np.vdot(wave, line)) ** 2 / np.vdot(wave, wave).real / np.vdot(line, line).real
    best = max(shares, key=lambda name: shares[name])
    return best if shares[best] >= OWN else "several patterns"


def typical(kind: type[Effect]) -> Effect:
    """An effect of typical size; choices and positions are their first or default values."""
    values = {name: quantity.typical for name, quantity in quantities(kind).items()}
    if values.get("sensor") == 0:
        values["sensor"] = 1
    return kind(**values)


def signatures(kinds: Sequence[type[Effect]], gear: Gear, sectors: int = SECTORS) -> list[Signature]:
    """Signatures of effects, all simulated at once."""
    runs = [
        Run(gear, point, effects, conditions=CONDITIONS)
        for kind in kinds
        for setting in (OTHER_SETTINGS.get(kind, USUAL),)
        for effects in (setting.beside, (*setting.beside, typical(kind)))
        for point in setting.points
    ]
    recordings = simulate_turns(runs, REVOLUTIONS, SAMPLES, sectors)
    values = np.array([[recording.channels[name] for name in SHOWN_CHANNELS] for recording in recordings])
    without, with_it = np.moveaxis(values.reshape(len(kinds), 2, 3, len(SHOWN_CHANNELS), -1), 1, 0)
    largest_line = np.abs(lines(without)[..., 1:]).max(axis=-1)
    return [Signature(*each) for each in zip(kinds, lines(with_it - without), largest_line, strict=True)]


def lines(values: Float[np.ndarray, "*batch time"]) -> Complex[np.ndarray, "*batch line"]:
    """Amplitudes over time at twelfths of an order, which are nearly those over the angle."""
    found = 2 * np.fft.rfft(values, axis=-1, norm="forward")[..., : REVOLUTIONS * ORDERS + 1]
    found[..., 0] /= 2
    return found
