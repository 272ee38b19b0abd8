"""Order lines: spectrum of signals over the angle of the wave generator, and its inverse."""

import numpy as np
from jaxtyping import Complex, Float

from swgsim.storage.labelled_signals import LabelledSignals


def whole_revolutions(speed_rpm: float, rate: float, length: int) -> int:
    """Number of samples of the largest whole number of wave-generator revolutions in a window of ``length`` samples.

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
    """Complex amplitude of signals at the orders 0 to ``orders`` of the speed n_in [unit of the signals].

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


def fft_bins(signals: Float[np.ndarray, "sample channel time"], bins: int) -> Complex[np.ndarray, "sample channel bin"]:
    """Complex amplitude of signals in the bins 0 to ``bins`` of the FFT of the whole window [unit of the signals].

    A cosine of amplitude a that is periodic in the window gives a in its bin. One that is not leaks into all bins.

    >>> turns = np.arange(100) / 100
    >>> np.abs(fft_bins(np.cos(2 * np.pi * 3 * turns)[None, None], 4)).round(6)
    array([[[0., 0., 0., 1., 0.]]])

    Raises
    ------
    ValueError
        If the highest bin is not below half the sampling rate.
    """
    length = signals.shape[-1]
    if not 2 * bins < length:
        raise ValueError(f"{bins} bins of a window of {length} samples: fewer than {(length + 1) // 2} are possible")
    lines = np.fft.rfft(signals, norm="forward")[..., : bins + 1]
    lines[..., 1:] *= 2
    return lines


def lines_of(recordings: LabelledSignals, orders: int) -> Complex[np.ndarray, "sample sensor order"]:
    """Order lines 0 to ``orders`` of recordings [mV/V], over whole revolutions at the desired speed of each."""
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
    """One periodic revolution at equally spaced angles, from its order lines.

    It is the synchronous average over the revolutions of the window, limited to the orders of the lines.

    Raises
    ------
    ValueError
        If a period of the highest order has two points or fewer.
    """
    orders = lines.shape[-1] - 1
    if not points > 2 * orders:
        raise ValueError(f"{points} points for orders up to {orders}: more than {2 * orders} are needed")
    scale = np.full(orders + 1, points / 2)
    scale[0] = points
    return np.fft.irfft(lines * scale, points, axis=-1)
