"""Order lines of a unit that differ from those of the chain, as its healthy recordings show them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD, FULL_SPEED
from swgsim.flexspline.gauges import GaugeSet
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import along_basis, basis
from swgsim.storage.labelled_signals import SENSORS

# What lines may follow over operating points, of load and speed in units of full ones; powers of the load come first.
LAWS: tuple[Callable[[np.ndarray, float], np.ndarray | float], ...] = (
    lambda load, speed: 1.0,
    lambda load, speed: load,
    lambda load, speed: load**2,
    lambda load, speed: speed,
    lambda load, speed: load * speed,
)

# Those that have nothing without a load.
LOADED = np.array([np.all(law(np.zeros(1), 1.0) == 0) for law in LAWS])


def laws(T_out: Float[np.ndarray, "..."], n_in_rpm: float) -> Float[np.ndarray, "law ..."]:
    """All laws at a torque [N m] and a speed [rpm]."""
    load, speed = T_out / FULL_LOAD, n_in_rpm / FULL_SPEED
    found = np.empty((len(LAWS), *load.shape))
    for number, law in enumerate(LAWS):
        found[number] = law(load, speed)
    return found


@dataclass(frozen=True, eq=False)
class Lines:
    """Complex order lines by law; the signal is Re(sum of lines[k] exp(i k phi)).

    Attributes
    ----------
    channels : tuple of str
    values : array (law, channel, order)
        In the unit of each channel.
    gauges : GaugeSet
        At which they were found.
    """

    channels: tuple[str, ...]
    values: Complex[np.ndarray, "law channel order"]
    gauges: GaugeSet

    def seen_by(self, gauges: GaugeSet) -> "Lines":
        """The same lines as other gauges see them: later if they have moved, and as much larger as their gain is."""
        values, orders = self.values.copy(), np.arange(self.values.shape[-1])
        for number, name in enumerate(self.channels):
            if name in SENSORS:
                sensor = SENSORS.index(name)
                was, now = self.gauges.gain[sensor], gauges.gain[sensor]
                moved = gauges.position[sensor] - self.gauges.position[sensor]
                values[:, number] *= (now / was if was else 1.0) * np.exp(-1j * moved * orders)
        return Lines(self.channels, values, gauges)

    def plus(self, more: "Lines") -> "Lines":
        """With what lines of the same channels, seen by the same gauges, add."""
        return Lines(self.channels, self.values + more.values, self.gauges)


@dataclass(frozen=True)
class OwnLines(Effect):
    """What a structure or a drive other than the model's adds to the lines of gauges and drive.

    It comes before all other effects, so that whatever delays, filters or clips a signal does so to the whole of it. A
    gauge that has moved since sees them later, and one of another gain as much larger; the torque that they follow is
    felt at all angles at once. Lobes that turn ahead take the lines along, and what is there without a load goes with
    their stroke.

    Attributes
    ----------
    lines : Lines
    gauges : GaugeSet
        That see them.
    lobes : complex
        Stroke and turn of the lobes since (:func:`swgsim.chain.influence.lobes`).
    """

    place = "structure"
    lines: Lines
    gauges: GaugeSet
    lobes: complex = 1.0

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The bridge signals with their lines."""
        bridges, along = _of_gauges(self.lines, self.gauges, self.lobes)
        waves = along @ self._basis(scene)
        seen = signals.copy()
        # The structure follows the torque at once, and so its ripple.
        seen[bridges] += np.einsum("lbt,lt->bt", waves, laws(scene.T_out, scene.point.n_in_rpm))
        return seen

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels of the drive with their lines."""
        drive, along = _of_drive(self.lines, scene.point)
        waves = along @ self._basis(scene)
        return {**channels, **{name: channels[name] + wave for name, wave in zip(drive, waves, strict=True)}}

    def _basis(self, scene: Scene) -> Float[np.ndarray, "column time"]:
        """The cosine and sine of the lines' orders over time."""
        return _orders(scene.phi_in.tobytes(), self.lines.values.shape[-1] - 1)


# Needed in every run of a fit.
@lru_cache(maxsize=1024)
def _of_gauges(
    lines: Lines, gauges: GaugeSet, lobes: complex
) -> tuple[list[int], Float[np.ndarray, "law bridge column"]]:
    """The bridges that have lines, and what these have along the basis as the gauges see them now."""
    own = [name for name in lines.channels if name in SENSORS]
    values = _of(lines.seen_by(gauges), own)
    ahead = np.exp(0.5j * np.angle(lobes) * np.arange(values.shape[-1]))
    stroke = np.where(LOADED, 1.0, abs(lobes))[:, None, None]
    return [SENSORS.index(name) for name in own], along_basis(values * ahead * stroke)


@lru_cache(maxsize=1024)
def _of_drive(lines: Lines, point: OperatingPoint) -> tuple[list[str], Float[np.ndarray, "channel column"]]:
    """The channels of the drive that have lines, and what these have along the basis at an operating point."""
    drive = [name for name in lines.channels if name not in SENSORS]
    here = laws(np.array(point.T_out), point.n_in_rpm)
    return drive, along_basis(np.tensordot(here, _of(lines, drive), 1))


def _of(lines: Lines, names: Sequence[str]) -> Complex[np.ndarray, "law channel order"]:
    """The lines of some channels."""
    return lines.values[:, [lines.channels.index(name) for name in names]]


# Motions are shared by runs that differ in gauges and acquisition, of which a fit has many; 135 kB each at most.
@lru_cache(maxsize=256)
def _orders(angles: bytes, orders: int) -> Float[np.ndarray, "column time"]:
    """What the orders up to one are over time; the angles [rad] are what identifies a motion."""
    return np.ascontiguousarray(basis(np.frombuffer(angles), orders).T)
