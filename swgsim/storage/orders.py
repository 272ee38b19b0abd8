"""Order lines: the spectrum of signals over the angle of the wave generator, and one revolution made of them."""

import numpy as np
from jaxtyping import Complex, Float

from swgsim.storage.labelled_signals import LabelledSignals


def whole_revolutions(speed_rpm: float, rate: float, length: int) -> int:
    """Samples in the largest whole number of wave-generator revolutions that a window of `length` samples holds.

    >>> whole_revolutions(2000.0, rate=10_000.0, length=650)
    600

    Raises
    ------
    ValueError
        If the window is shorter than one revolution.
    """
    revolution = 60 * rate / speed_rpm
    count = int(length / revolution + 1e-9)
    if count < 1:
        raise ValueError(
            f"the window of {length} samples holds {length / revolution:.2f} revolutions at {speed_rpm:g} rpm and "
            f"{rate:g} Hz, at least 1 is needed: record {int(np.ceil(revolution))} samples or more"
        )
    return round(count * revolution)


def order_lines(
    signals: Float[np.ndarray, "sample channel time"], speed_rpm: float, rate: float, orders: int
) -> Complex[np.ndarray, "sample channel order"]:
    """Complex amplitude of the signals at the orders 0 to `orders` of the speed n_in [unit of signals].

    Over whole revolutions at angle theta, ``signals = Re(sum of lines[k] exp(i k theta))``: a cosine of amplitude a at
    an integer order gives a at that order and 0 at the others; the line of order 0 is the mean.

    Raises
    ------
    ValueError
        If the highest order is not below half the sampling rate.
    """
    highest = orders * speed_rpm / 60
    if not highest < rate / 2:
        raise ValueError(
            f"order {orders} at {speed_rpm:g} rpm lies at {highest:g} Hz, the limit is half the sampling rate, "
            f"{rate / 2:g} Hz: take fewer orders or a higher sampling rate"
        )
    length = signals.shape[-1]
    turns = np.arange(length) * speed_rpm / 60 / rate
    waves = np.exp(-2j * np.pi * np.outer(turns, np.arange(1, orders + 1))) * (2 / length)  # (time, order)
    mean = signals.mean(axis=-1, keepdims=True)
    zero_mean = signals - mean
    return np.concatenate([mean, zero_mean @ waves.real + 1j * (zero_mean @ waves.imag)], axis=-1)


def lines_of(recordings: LabelledSignals, orders: int) -> Complex[np.ndarray, "sample sensor order"]:
    """Order lines 0 to `orders` of recordings [mV/V], over the whole revolutions at each one's desired speed."""
    speeds = recordings.table["n_in_rpm"].to_numpy()
    result = np.empty((len(recordings), recordings.signals.shape[1], orders + 1), dtype=np.complex128)
    for speed in np.unique(speeds):
        rows = speeds == speed
        length = whole_revolutions(float(speed), recordings.rate, recordings.signals.shape[-1])
        s = recordings.signals[rows, :, :length].astype(np.float64)
        result[rows] = order_lines(s, float(speed), recordings.rate, orders)
    return result


def revolution(
    lines: Complex[np.ndarray, "sample channel order"], points: int
) -> Float[np.ndarray, "sample channel point"]:
    """One revolution at equally spaced angles, made of its order lines; it is periodic.

    This is the synchronous average over the revolutions of the window, limited to the orders that the lines hold.

    Raises
    ------
    ValueError
        If there are not more than two points to a period of the highest order.
    """
    orders = lines.shape[-1] - 1
    if not points > 2 * orders:
        raise ValueError(f"{points} points for orders up to {orders}: more than {2 * orders} are needed")
    scale = np.full(orders + 1, points / 2)
    scale[0] = points
    return np.fft.irfft(lines * scale, points, axis=-1)
