"""Where the lines of a gear lie off the model's, as recordings of its healthy state show them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.regularity import FULL_SPEED
from swgsim.gear import Gear, OperatingPoint
from swgsim.recordings import SENSORS

# How many laws there are of load and speed.
LAWS = 5


def laws(point: OperatingPoint) -> Float[np.ndarray, " law"]:
    """What lines may follow over operating points: 1, the load, its square, the speed, and both together."""
    load, speed = point.T_out / FULL_LOAD, point.n_in_rpm / FULL_SPEED
    return np.array([1.0, load, load**2, speed, load * speed])


@dataclass(frozen=True, eq=False)
class Lines:
    """Complex order lines by law; the signal is Re(sum of lines[k] exp(i k phi)).

    Attributes
    ----------
    channels : tuple of str
    values : array (law, channel, order)
        In the unit of each channel.
    """

    channels: tuple[str, ...]
    values: Complex[np.ndarray, "law channel order"]


@dataclass(frozen=True)
class Deviation(Effect):
    """Lines on gauges and drive that a structure or a drive other than the model's makes.

    It comes before all effects, so that whatever delays, scales, filters or clips a signal does so to the whole of it.

    Attributes
    ----------
    lines : Lines
    gain : tuple of float
        Of every gauge, in units of that at which its lines were found.
    """

    place = "structure"
    lines: Lines
    gain: tuple[float, ...] = (1.0,) * len(SENSORS)

    def gained(self, gear: Gear, affected: Gear) -> "Deviation":
        """The deviation seen by gauges whose gains effects have changed."""
        gain = np.divide(affected.gauges.gain, gear.gauges.gain)
        return replace(self, gain=tuple(gain.tolist()))

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The bridge signals with their lines."""
        waves = self._waves(scene)
        own = [waves.get(sensor, 0.0) * gain for sensor, gain in zip(SENSORS, self.gain, strict=True)]
        return np.array([signal + wave for signal, wave in zip(signals, own, strict=True)])

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels of the drive with their lines."""
        waves = self._waves(scene)
        return {**channels, **{name: channels[name] + waves[name] for name in waves if name not in SENSORS}}

    def _waves(self, scene: Scene) -> dict[str, Float[np.ndarray, " time"]]:
        lines = np.tensordot(laws(scene.point), self.lines.values, 1)
        turns = np.exp(1j * np.outer(np.arange(lines.shape[1]), scene.phi_in))
        return dict(zip(self.lines.channels, (lines @ turns).real, strict=True))
