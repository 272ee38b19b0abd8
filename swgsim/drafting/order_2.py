"""Two cycles per revolution of the wave generator: what tells gauges from other channels, and the unit of the angle."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Complex, Float

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.motion import filled
from swgsim.recordings.checks.thresholds import ORDER_2_SHARE

FITTED_ORDERS = 4


def order_2(column: FileColumn, angle: Float[np.ndarray, " time"]) -> Complex[np.ndarray, ""]:
    """Amplitude and phase at two cycles per revolution, as a share of half the range of the channel.

    Parameters
    ----------
    column : FileColumn
    angle : array (time,)
        Of the wave generator [rad].
    """
    values, k = filled(column.values), np.arange(1, FITTED_ORDERS + 1)[:, None]
    low, high = np.quantile(values, [0.005, 0.995])
    if high <= low or np.ptp(angle) < 2 * np.pi:
        return np.asarray(0j)
    # A ramp takes up what rises with time, such as an angle, which has lines of all orders.
    ramp = np.linspace(-1, 1, len(angle))
    waves = np.concatenate([np.ones((1, len(angle))), ramp[None], np.cos(k * angle), np.sin(k * angle)])
    weights = np.linalg.lstsq(waves.T, values, rcond=None)[0]
    return np.asarray((weights[3] - 1j * weights[FITTED_ORDERS + 3]) / ((high - low) / 2))


def has_order_2(column: FileColumn, angle: Float[np.ndarray, " time"]) -> bool:
    """Whether a channel sees the two lobes of the wave generator."""
    return bool(abs(order_2(column, angle)) > ORDER_2_SHARE)


def clearest(columns: Sequence[FileColumn], angles: Sequence[Float[np.ndarray, " time"]]) -> int:
    """Place of the angle by which the channels show the most of two cycles per revolution."""
    return int(np.argmax([sum(float(abs(order_2(column, angle))) for column in columns) for angle in angles]))
