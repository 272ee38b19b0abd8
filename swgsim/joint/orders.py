"""Orders that stand out of a residual: lines over the angle of the joint, of any phase and any law of speed."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.ndimage import median_filter

from swgsim.common.chi2_logsf import log_tail
from swgsim.joint.regression import Table

# Oversampling of the resolution of orders, and the highest order if the gear ratio is unknown.
FINENESS, HIGHEST_ORDER = 4, 2500
# Highest order as a multiple of the gear ratio.
HIGHEST_MULTIPLE = 25
# A recording must contain so many waves of an order.
LEAST_WAVES = 2.0
# Lines within so many resolutions of a stronger line belong to it.
LEAKAGE_LINES = 4
# Share of the samples of a recording that must be dense enough for a wave.
SLOWER = 0.3
# Width of the median filter for the noise, in units of FINENESS lines.
MEDIAN_WIDTH = 40


class Line(NamedTuple):
    """A line: waves per revolution of the output, logarithm of its p-value among all orders."""

    order: float
    log_chance: float


def lines(table: Table, residual: Float[np.ndarray, " row"], level: float, most: int, *, above: float) -> list[Line]:
    """Significant orders, the least likely first.

    Phases and amplitudes may differ between recordings. The noise at an order is the median of its neighbours.

    Parameters
    ----------
    table : Table
    residual : array (row,)
    level : float
        Probability of any false order.
    most : int
        Largest number of lines.
    above : float
        Lowest order.
    """
    ratio = max((each.gear_ratio or 0 for each in table.recordings), default=0)
    highest = int(HIGHEST_MULTIPLE * ratio) or HIGHEST_ORDER
    orders, power = spectrum(table, residual, highest)
    numbers = 2 * np.isfinite(power).sum(axis=0)
    log_chance = log_tail(np.nansum(power, axis=0), np.maximum(numbers, 1)) + np.log(len(orders))
    log_chance[(numbers == 0) | (orders <= above)] = 0.0
    found: list[Line] = []
    # Neighbours of a line belong to it.
    width = LEAKAGE_LINES * 2 * np.pi / max(float(np.ptp(each.signals["q"])) for each in table.recordings)
    free = np.ones(len(orders), bool)
    while len(found) < most:
        best = int(np.where(free, log_chance, 0.0).argmin())
        if not free[best] or log_chance[best] > np.log(level):
            break
        found.append(Line(float(orders[best]), float(log_chance[best])))
        free &= np.abs(orders - orders[best]) > width
    return found


def spectrum(
    table: Table, residual: Float[np.ndarray, " row"], highest: int
) -> tuple[Float[np.ndarray, " order"], Float[np.ndarray, "law order"]]:
    """Power of every recording at every order, in units of the noise near it, 2 on average; NaN where a recording is
    too short or too slowly sampled for the order.

    A recording that reverses has two: of waves that are the same in both directions, and of waves that change their
    sign with the direction.
    """
    # Bins of the angle are a fifth of the shortest wave.
    width = 2 * np.pi / (5 * highest)
    spans = [float(np.ptp(each.signals["q"])) for each in table.recordings]
    resolution = 2 * np.pi / max(spans)
    length = int(2 ** np.ceil(np.log2(2 * np.pi * FINENESS / (resolution * width))))
    orders = 2 * np.pi * np.arange(1, length // 2) / (length * width)
    orders = orders[orders <= highest]
    power = np.full((2 * len(table.recordings), len(orders)), np.nan)
    for number, each in enumerate(table.recordings):
        q, r = each.signals["q"], residual[table.run == number]
        # Where the speed varies, fast stretches miss a wave but do not alias it to one order.
        usual = float(np.quantile(np.abs(each.signals["omega"]), SLOWER))
        seen = (orders * spans[number] >= LEAST_WAVES * 2 * np.pi) & (orders * usual < 0.8 * np.pi * each.rate)
        if not seen.any():
            continue
        place = np.floor((q - q.min()) / width).astype(int)
        # The lines of a short recording are as wide as many of a long one.
        wide = max(1, int(max(spans) / spans[number]))
        for law, by in enumerate((np.ones(len(r)), np.sign(each.speed))):
            if np.ptp(by) > 0 or law == 0:
                total = np.bincount(place, by * r - (by * r).mean())
                # The taper keeps strong lines within their own bins.
                total = total * np.hanning(len(total))
                raw = np.abs(np.fft.rfft(total, length)[1 : len(orders) + 1]) ** 2
                noise = median_filter(raw, MEDIAN_WIDTH * FINENESS * wide, mode="reflect") / np.log(2)
                power[2 * number + law] = np.where(seen, 2 * raw / np.maximum(noise, 1e-300), np.nan)
    return orders, power
