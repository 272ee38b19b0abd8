"""White noise of every channel, from what lies between the integer orders of a recording."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.loop.features import ORDERS, Layout, basis, remainder
from swgsim.recording import Recording

# Share of a channel's size below which neither a converter nor the chain's own numerics resolve anything.
RESOLVED = 1e-4
# Lines this close to an integer order may hold what leaks from it [lines of the spectrum].
GUARD = 1.5


def white_variance(recordings: Sequence[Recording], layout: Layout) -> Float[np.ndarray, "recording feature"]:
    """Variance of every feature by white noise, from the median of the spectrum between the integer orders.

    The median does not mind a few lines, such as those of a bearing cage or of the mains.
    """
    levels = np.array([density(recording, layout) for recording in recordings])
    steady = layout.order == 0
    # All recordings of a channel have one amplifier.
    level = np.maximum(np.median(levels, axis=0), 0.0)
    found = []
    for recording in recordings:
        columns = basis(recording.channels["phi_in"], ORDERS)
        spread = np.diag(np.linalg.inv(columns.T @ columns))
        ripple, mean = (np.repeat(part, len(spread)) for part in _sizes(recording, layout))
        floor = (RESOLVED * np.where(steady, mean + ripple, ripple)) ** 2
        found.append(np.outer(level, spread).ravel() + floor)
    return np.array(found)


def _sizes(recording: Recording, layout: Layout) -> tuple[np.ndarray, np.ndarray]:
    """Ripple and mean of every channel."""
    values = np.array([recording.channels[name] for name in layout.channels])
    return values.std(axis=1), np.abs(values.mean(axis=1))


def density(recording: Recording, layout: Layout) -> Float[np.ndarray, " channel"]:
    """Variance of a white noise with the spectrum's median level between the integer orders [unit squared].

    Raises
    ------
    ValueError
        If the recording is so short that nothing lies between the orders.
    """
    left = remainder(recording, layout)
    angle = recording.channels["phi_in"]
    revolutions = abs(float(angle[-1] - angle[0])) / (2 * np.pi)
    spectrum = np.abs(np.fft.rfft(left, axis=1)) ** 2 / left.shape[1]
    order = np.arange(spectrum.shape[1]) / revolutions
    between = (np.abs(order - np.round(order)) * revolutions > GUARD) & (order < ORDERS + 0.5)
    if between.sum() < 8:
        raise ValueError(
            f"recording {recording.name}: {revolutions:.1f} revolutions leave {between.sum()} lines between the "
            "integer orders, at least 8 are needed to see the noise: record 4 revolutions or more, better 12"
        )
    return np.median(spectrum[:, between], axis=1) / np.log(2)
