"""Noise of every channel over frequency, from what lies between the integer orders of the recordings.

White noise and, below some corner, slow noise as of an amplifier or a drifting zero,

    S(f) = white + slow / (1 + (f / corner)^2).

The fit is robust, so that a few lines, such as those of a bearing cage or of the mains, do not count as noise.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from swgsim.identification.data.features import FITTED, ORDERS, Layout, basis, remainder
from swgsim.recordings.recording import Recording

# Shares of a channel's ripple, and of its mean, below which neither a converter nor the chain's own numerics resolve
# anything.
RESOLVED, FINEST = 1e-4, 1e-6
# Lines this close to an integer order may hold what leaks from it [lines of the spectrum].
GUARD = 1.5
# Smallest number of interharmonic lines of a recording from which noise is estimated.
FEWEST_LINES = 8
# Mean of the logarithm of a periodogram line over its expectation: minus Euler's constant.
LOG_MEAN = -0.5772156649


@dataclass(frozen=True)
class Floor:
    """Noise of one channel.

    Attributes
    ----------
    white : float
        Variance of the white part [unit squared].
    slow : float
        Additional level of the slow part at frequency 0.
    corner : float
        Above it the slow part falls off [Hz].
    """

    white: float
    slow: float
    corner: float

    def at(self, frequency: Float[np.ndarray, " line"]) -> Float[np.ndarray, " line"]:
        """Variance of a white noise of the same density at a frequency [Hz]."""
        return self.white + self.slow / (1 + (frequency / self.corner) ** 2)


def floors(recordings: Sequence[Recording], layout: Layout) -> list[Floor]:
    """The noise of every channel, one amplifier for all recordings.

    Raises
    ------
    ValueError
        If a recording is so short that nothing lies between the orders.
    """
    lines = [_between(recording, layout) for recording in recordings]
    frequency = np.concatenate([f for f, _ in lines])
    power = np.concatenate([p for _, p in lines], axis=1)
    return [_fitted(frequency, channel) for channel in power]


def variance(
    recordings: Sequence[Recording], layout: Layout, noise: Sequence[Floor]
) -> Float[np.ndarray, "recording feature"]:
    """Variance of every feature by noise and by the resolution of the channels."""
    found = []
    for recording in recordings:
        columns = basis(recording.channels["phi_in"], ORDERS)
        spread = np.diag(np.linalg.inv(columns.T @ columns))
        frequency = layout.order[: len(spread)] * recording.point.n_in_rpm / 60
        ripple, mean = _sizes(recording, layout)
        least = np.repeat(RESOLVED * ripple + FINEST * mean, len(spread))
        least[layout.order == 0] = RESOLVED * (ripple + mean)
        found.append(np.concatenate([floor.at(frequency) * spread for floor in noise]) + least**2)
    return np.array(found)


def step_of(values: Float[np.ndarray, " time"]) -> float:
    """Step of the converter that a channel went through, at most: the least difference of two values."""
    return float(np.diff(np.unique(values)).min(initial=np.inf)) if np.ptp(values) else 0.0


def _between(
    recording: Recording, layout: Layout
) -> tuple[Float[np.ndarray, " line"], Float[np.ndarray, "channel line"]]:
    """Frequencies [Hz] and power of the spectrum's lines between the orders that are fitted."""
    left = remainder(recording, layout)
    angle = recording.channels["phi_in"]
    revolutions = abs(float(angle[-1] - angle[0])) / (2 * np.pi)
    # A window, so that a strong line stays where it is.
    window = np.hanning(left.shape[1])
    power = np.abs(np.fft.rfft(left * window, axis=1)) ** 2 / (window @ window)
    frequency = np.fft.rfftfreq(left.shape[1], 1 / recording.rate)
    order = np.arange(len(frequency)) / revolutions
    between = (np.abs(order - np.round(order)) * revolutions > GUARD) & (order < FITTED)
    if between.sum() < FEWEST_LINES:
        raise ValueError(
            f"recording {recording.name}: {revolutions:.1f} revolutions leave {between.sum()} lines between the "
            f"integer orders, at least {FEWEST_LINES} are needed to see the noise: record 4 revolutions or more, "
            "better 12"
        )
    return frequency[between], power[:, between]


def _fitted(frequency: Float[np.ndarray, " line"], power: Float[np.ndarray, " line"]) -> Floor:
    """The floor that the logarithms of the lines are nearest to."""
    level = float(np.median(power)) / np.log(2)
    if level <= 0:
        return Floor(0.0, 0.0, 1.0)
    lowest, highest = float(frequency.min()), float(frequency.max())
    seen = np.log(np.maximum(power / level, 1e-12)) - LOG_MEAN

    def missed(x: np.ndarray) -> np.ndarray:
        white, slow, corner = np.exp(x)
        return np.log(white + slow / (1 + (frequency / corner) ** 2)) - seen

    bounds = (np.log([1e-3, 1e-6, lowest / 3]), np.log([1e2, 1e8, highest]))
    start = np.log([1.0, 1e-2, np.sqrt(lowest * highest)])
    white, slow, corner = np.exp(least_squares(missed, start, bounds=bounds, loss="soft_l1").x)
    # The robust loss leans to one side, as logarithms of a periodogram do; the median sets the level right.
    shape = white + slow / (1 + (frequency / corner) ** 2)
    right = float(np.median(power / level / shape)) / np.log(2)
    return Floor(level * right * white, level * right * slow, corner)


def _sizes(recording: Recording, layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """Ripple and mean of every channel."""
    values = np.array([recording.channels[name] for name in layout.channels])
    return values.std(axis=1), np.abs(values.mean(axis=1))
