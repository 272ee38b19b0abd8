"""Lines of a gear where the chain has them elsewhere, as recordings of its healthy state show them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD, FULL_SPEED
from swgsim.gauges import GaugeSet
from swgsim.loop.features import along_basis, basis
from swgsim.recordings import SENSORS

# What lines may follow over operating points, of load and speed in units of full ones.
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
    return np.array([law(load, speed) + 0 * load for law in LAWS])


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
        Stroke and turn of the lobes since (:func:`swgsim.influence.lobes`).
    """

    place = "structure"
    lines: Lines
    gauges: GaugeSet
    lobes: complex = 1.0

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The bridge signals with their lines."""
        own = [name for name in self.lines.channels if name in SENSORS]
        lines = _of(self.lines.seen_by(self.gauges), own)
        ahead = np.exp(0.5j * np.angle(self.lobes) * np.arange(lines.shape[-1]))
        waves = _waves(lines * ahead * np.where(LOADED, 1.0, abs(self.lobes))[:, None, None], scene)
        seen = signals.copy()
        # The structure follows the torque at once, and so its ripple.
        seen[[SENSORS.index(name) for name in own]] += (waves * laws(scene.T_out, scene.point.n_in_rpm)[:, None]).sum(
            axis=0
        )
        return seen

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels of the drive with their lines."""
        drive = [name for name in self.lines.channels if name not in SENSORS]
        here = laws(np.array(scene.point.T_out), scene.point.n_in_rpm)
        waves = _waves(np.tensordot(here, _of(self.lines, drive), 1), scene)
        return {**channels, **{name: channels[name] + wave for name, wave in zip(drive, waves, strict=True)}}


def _of(lines: Lines, names: Sequence[str]) -> Complex[np.ndarray, "law channel order"]:
    """The lines of some channels."""
    return lines.values[:, [lines.channels.index(name) for name in names]]


def _waves(lines: Complex[np.ndarray, "*batch order"], scene: Scene) -> Float[np.ndarray, "*batch time"]:
    """What lines are over time."""
    return along_basis(lines) @ basis(scene.phi_in, lines.shape[-1] - 1).T
