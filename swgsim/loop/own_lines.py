"""Lines of a gear where the chain has them elsewhere, as recordings of its healthy state show them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.regularity import FULL_SPEED
from swgsim.gear import OperatingPoint
from swgsim.recordings import SENSORS

# What lines may follow over operating points, of load and speed in units of full ones.
LAWS: tuple[Callable[[float, float], float], ...] = (
    lambda load, speed: 1.0,
    lambda load, speed: load,
    lambda load, speed: load**2,
    lambda load, speed: speed,
    lambda load, speed: load * speed,
)


def laws(point: OperatingPoint) -> Float[np.ndarray, " law"]:
    """All laws at an operating point."""
    load, speed = point.T_out / FULL_LOAD, point.n_in_rpm / FULL_SPEED
    return np.array([law(load, speed) for law in LAWS])


@dataclass(frozen=True, eq=False)
class Lines:
    """Complex order lines by law; the signal is Re(sum of lines[k] exp(i k phi)).

    Attributes
    ----------
    channels : tuple of str
    values : array (law, channel, order)
        In the unit of each channel.
    gain : tuple of float
        Of every gauge, at which they were found.
    """

    channels: tuple[str, ...]
    values: Complex[np.ndarray, "law channel order"]
    gain: tuple[float, ...]


@dataclass(frozen=True)
class OwnLines(Effect):
    """What a structure or a drive other than the model's adds to the lines of gauges and drive.

    It comes before all other effects, so that whatever delays, filters or clips a signal does so to the whole of it.

    Attributes
    ----------
    lines : Lines
    gain : tuple of float
        Of every gauge that sees them.
    """

    place = "structure"
    lines: Lines
    gain: tuple[float, ...]

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The bridge signals with their lines."""
        waves = self._waves(scene)
        was = np.array(self.lines.gain)
        share = np.divide(self.gain, was, out=np.ones(len(was)), where=was != 0)
        own = [waves.get(sensor, np.zeros(signals.shape[1])) for sensor in SENSORS]
        return signals + share[:, None] * np.array(own)

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels of the drive with their lines."""
        drive = [name for name in self.lines.channels if name not in SENSORS]
        if not drive:
            return channels
        waves = self._waves(scene)
        return {**channels, **{name: channels[name] + waves[name] for name in drive}}

    def _waves(self, scene: Scene) -> dict[str, Float[np.ndarray, " time"]]:
        lines = np.tensordot(laws(scene.point), self.lines.values, 1)
        turns = np.exp(1j * np.outer(np.arange(lines.shape[1]), scene.phi_in))
        return dict(zip(self.lines.channels, (lines @ turns).real, strict=True))
