"""How people move a joint to record it: angle, speed and acceleration at the cycle of the drive.

Sines and Fourier series as in J. Swevers, W. Verdonck and J. De Schutter, Dynamic model identification for industrial
robots, IEEE Control Systems 27(5), 2007; the others are the moves of every robot's controller.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.integrate import cumulative_trapezoid

from robots.plant import CYCLE

LONGEST = 40.0  # s, of a recording


class Limits(NamedTuple):
    """Amplitude [rad], peak speed [rad/s] and peak acceleration [rad/s^2]."""

    amplitude: float
    speed: float
    acceleration: float


def sine(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """To and fro; at least one and a half periods."""
    rate = min(limits.speed / limits.amplitude, np.sqrt(limits.acceleration / limits.amplitude))
    time = _time(rng, at_least=1.5 * 2 * np.pi / rate)
    return _from_angle(limits.amplitude * np.sin(rate * time), time)


def chirp(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """Sine whose frequency grows tenfold, to 3 Hz at most; its amplitude falls so that speed and acceleration hold."""
    slowest = min(limits.speed / limits.amplitude, np.sqrt(limits.acceleration / limits.amplitude), 2 * np.pi * 0.5)
    time = _time(rng)
    rate = np.geomspace(slowest, min(10 * slowest, 2 * np.pi * 3), len(time))
    size = np.minimum(limits.amplitude, np.minimum(limits.speed / rate, limits.acceleration / rate**2))
    return _from_angle(size * np.sin(cumulative_trapezoid(rate, time, initial=0)), time)


def fourier(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """Five harmonics with random amplitudes."""
    time = _time(rng)
    slowest = 2 * np.pi / rng.uniform(8, 20)
    rate = slowest * np.arange(1, 6)[:, None]
    waves = (rng.normal(0, 1, (5, 1)) * np.sin(rate * time + rng.uniform(0, 2 * np.pi, (5, 1))) / rate).sum(axis=0)
    largest = [np.abs(waves).max(), np.abs(np.gradient(waves, CYCLE)).max()]
    largest.append(np.abs(np.gradient(np.gradient(waves, CYCLE), CYCLE)).max())
    return _from_angle(waves * min(limit / each for limit, each in zip(limits, largest, strict=True)), time)


def strokes(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """Constant speed to and fro with ramps."""
    ways = [limits.amplitude] + [-2 * limits.amplitude, 2 * limits.amplitude] * 100
    return _trapezoids(ways, limits, pause=0.0, longest=max(_length(rng), 4.2 * limits.amplitude / limits.speed))


def one_way(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """Constant speed in one direction with ramps at both ends, as far as the joint gets: one that turns for ever."""
    way = rng.choice([-1, 1]) * limits.speed * rng.uniform(6, 20)
    return _trapezoids([way], limits, pause=0.2, longest=LONGEST)


def point_to_point(limits: Limits, rng: np.random.Generator) -> Float[np.ndarray, "3 cycle"]:
    """Random targets with pauses."""
    targets = rng.uniform(-limits.amplitude, limits.amplitude, 200)
    return _trapezoids(np.diff(targets, prepend=0.0), limits, pause=rng.uniform(0, 1), longest=_length(rng))


def _length(rng: np.random.Generator) -> float:
    return float(rng.uniform(12, LONGEST))


def _time(rng: np.random.Generator, at_least: float = 0.0) -> Float[np.ndarray, " cycle"]:
    return np.arange(0, max(_length(rng), at_least), CYCLE)


def _from_angle(angle: Float[np.ndarray, " cycle"], time: Float[np.ndarray, " cycle"]) -> Float[np.ndarray, "3 cycle"]:
    """Fade a movement in within a second: a joint starts at rest."""
    s = np.minimum(time, 1)
    angle = angle * (10 * s**3 - 15 * s**4 + 6 * s**5)
    speed = np.gradient(angle, CYCLE)
    return np.stack([angle, speed, np.gradient(speed, CYCLE)])


def _trapezoids(
    ways: Sequence[float] | Float[np.ndarray, " way"], limits: Limits, pause: float, longest: float
) -> Float[np.ndarray, "3 cycle"]:
    """Moves with constant acceleration, speed and deceleration one after the other, until ``longest`` [s]."""
    times, speeds = [0.0], [0.0]
    for way in ways:
        ramp = min(limits.speed / limits.acceleration, np.sqrt(abs(way) / limits.acceleration))
        peak = ramp * limits.acceleration
        times += list(times[-1] + np.cumsum([ramp, max(abs(way) / peak - ramp, 0), ramp, pause]))
        speeds += [np.sign(way) * peak, np.sign(way) * peak, 0.0, 0.0]
        if times[-1] > longest:
            break
    time = np.arange(0, min(times[-1], longest), CYCLE)
    speed = np.interp(time, times, speeds)
    return np.stack([cumulative_trapezoid(speed, time, initial=0), speed, np.gradient(speed, CYCLE)])


# One programme of a day: the forms it takes its runs from.
PROGRAMMES = {
    "sines": (sine,),
    "strokes": (strokes,),
    "one_way": (one_way,),
    "point_to_point": (point_to_point,),
    "chirps": (chirp,),
    "fourier": (fourier,),
    "mixed": (sine, strokes, point_to_point, chirp, fourier),
}
