"""Writes ``gear.c`` at the commissioning of a gear: its healthy numbers at every operating point."""

import numpy as np
from jaxtyping import Complex, Float, Int

from learn.embedded.front import Front, operating_points
from learn.embedded.source import array, number, pairs, values
from learn.inputs.references import healthy_reference
from swgsim.common.checks import require
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.storage.orders import whole_revolutions

HEAD = """/* The healthy gear, written by its commissioning. */
#include <math.h>
#include <stddef.h>

#include "swg.h"

"""
WAVE = 2**30  # unit of the waves by which samples are multiplied
DEVIATION, SUM = 2**29, 2**38  # counts that a deviation, and the sum of all deviations, may have (window.c)
QUARTERS = 4  # of a window, in each of which a gauge has to move (window.c)
LONGEST_WINDOW = 2**16  # samples of a window; beyond, the rounding of the waves shows
FULL_SCALE = 20.0  # mV/V, beyond which a count would be coarser than what single precision resolves


def gear_source(references: LabelledSignals, front: Front, saturation: float) -> str:
    """C source with the healthy numbers of one gear.

    Parameters
    ----------
    references : LabelledSignals
        Healthy recordings of one gear at all operating points.
    front : Front
        The features of the method.
    saturation : float
        Limit of the gauges' amplifiers [mV/V]; with larger samples there is no decision.

    Raises
    ------
    ValueError
        If the recordings are not of one gear, not healthy or reach the limit, or the limit or a window is too large.
    """
    table = references.table
    gears = sorted(map(str, table["gear"].unique()))
    if len(gears) != 1 or not table["reference"].all():
        raise ValueError(f"references of gears {', '.join(gears)} found: give the healthy references of one gear")
    highest = float(np.abs(references.signals).max())
    require("the amplifiers", "saturation", saturation, low=highest * (1 + 1e-6), high=FULL_SCALE)
    scale = _scale(saturation, references.signals.shape[-1])
    points = operating_points(references)
    measured = healthy_reference(table[["efficiency", "temperature_c"]].to_numpy(), table, points)
    healthy = front.healthy(references)
    arrays, entries = [], []
    for place, (speed, load) in enumerate(zip(points["n_in_rpm"], points["T_out_nm"], strict=True)):
        lines = _fixed(healthy.lines[place], 4 * scale)
        arrays += [f"static const swg_fixed line{place}[] = {pairs(lines)};\n"] if lines.size else []
        arrays += [array(f"healthy{place}", healthy.numbers[place], storage="static const")]
        of_point = ((table["n_in_rpm"] == speed) & (table["T_out_nm"] == load)).to_numpy()
        facts = ", ".join(map(number, (speed, load, *measured[place])))
        names = f"{f'line{place}' if lines.size else 'NULL'}, healthy{place}"
        entries.append(f"{{{facts},\n    {_signal(references.where(of_point), speed, front.orders)},\n    {names}}}")
    listed, facts = ",\n".join(entries), ", ".join(map(number, (references.rate, saturation, scale)))
    return (
        f"{HEAD}{''.join(arrays)}static const swg_point points[] = {{\n{listed}}};\n"
        f"const swg_gear swg_this_gear = {{{facts}, {len(points)}, points}};\n"
    )


def _scale(saturation: float, samples: int) -> float:
    """Counts per 1 mV/V: the largest power of 2 without overflow."""
    return float(2 ** np.floor(np.log2(min(DEVIATION, SUM / samples) / (2 * saturation))))


def _signal(references: LabelledSignals, speed: float, orders: int) -> str:
    """Entries of one operating point for the signals."""
    length = whole_revolutions(speed, references.rate, references.signals.shape[-1])
    require("the window", "samples", length, low=QUARTERS, high=LONGEST_WINDOW)
    turns = speed / 60 / references.rate  # revolutions from one sample to the next
    order = np.arange(1, max(orders, 1) + 1)
    turn = np.exp(-2j * np.pi * turns * order)  # of the angle between two samples
    # The mean over the samples is 0 if a revolution is a whole number of samples.
    offset = np.exp(-1j * (2 * np.pi * turns * np.outer(np.arange(length), order))).mean(axis=0)
    signals = references.signals[:, :, :length].astype(np.float64)
    mean, extent = signals.mean(axis=(0, 2)), _least_movement(signals)
    return ", ".join([str(length), values(mean), values(extent), pairs(_fixed(turn, WAVE)), pairs(_parts(offset))])


def _least_movement(signals: Float[np.ndarray, "recording sensor sample"]) -> Float[np.ndarray, " sensor"]:
    """Range of each gauge in the quarter of a window in which it moves least."""
    length = signals.shape[-1] // QUARTERS
    quarters = np.split(signals, [length * i for i in range(1, QUARTERS)], axis=-1)
    return np.min([np.ptp(quarter, axis=-1) for quarter in quarters], axis=(0, 1))


def _fixed(numbers: Complex[np.ndarray, "..."], unit: float) -> Int[np.ndarray, "number part"]:
    return np.rint(_parts(numbers) * unit).astype(np.int64)


def _parts(numbers: Complex[np.ndarray, "..."]) -> Float[np.ndarray, "number part"]:
    """Real and imaginary parts, one after the other whatever the shape was."""
    return np.stack([numbers.real, numbers.imag], axis=-1).reshape(-1, 2)
