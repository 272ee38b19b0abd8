"""Strain-gauge bridges: which of s0 to s4 a column is, and its unit."""

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.drafting.draft_line import DraftLine, joined, place
from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.motion import filled
from swgsim.drafting.named_column import NamedColumn
from swgsim.drafting.order_2 import order_2
from swgsim.recordings.checks.thresholds import GAUGE_LARGEST, GAUGE_SMALLEST
from swgsim.tables.units import FACTORS, OUTPUTS, STRAIN


def bridges(
    gauges: Sequence[NamedColumn], angle: Float[np.ndarray, " time"] | None, known: Mapping[str, Any]
) -> Iterator[DraftLine]:
    """Bridges s0 to s4."""
    names, why, ask = _numbered(gauges, angle)
    for name, each in zip(names, gauges, strict=False):
        column = each.column
        unit, more, need, doubt = _bridge_unit(column, known)
        share = (
            f"order 2 has {min(abs(order_2(column, angle)), 1.0):.0%} of its range"
            if angle is not None and np.ptp(angle) > 2 * pi
            else ""
        )
        reason = joined(each.meaning.why, why, share)
        yield DraftLine(
            column, name, place(column) | {"unit": unit} | more, reason, joined(ask, need, doubt), "", not need
        )


def _numbered(gauges: Sequence[NamedColumn], angle: Float[np.ndarray, " time"] | None) -> tuple[list[str], str, str]:
    """Names of the bridges in the order of the columns, the reason, and what the user must decide."""
    numbers = [each.index for each in gauges]
    if len(set(numbers)) == len(numbers) and None not in numbers and set(numbers) <= set(range(5)):
        lobes = [_amplitude(each.column, angle) for each in gauges] if angle is not None else []
        alike = lobes and 0 in numbers and lobes[numbers.index(0)] > 0.5 * float(np.median(lobes))
        if not (alike and len(numbers) == 4):
            return [f"s{number}" for number in numbers], "numbers in the names", ""
    if len(gauges) == 5 and angle is not None:
        weakest = int(np.argmin([_amplitude(each.column, angle) for each in gauges]))
        rest = iter(range(1, 5))
        names = ["s0" if place == weakest else f"s{next(rest)}" for place in range(5)]
        return names, "", "order as in the file; s0 is the one with the weakest order 2"
    return [f"s{number}" for number in range(1, min(len(gauges), 4) + 1)], "", "order as in the file"


def _amplitude(column: FileColumn, angle: Float[np.ndarray, " time"]) -> float:
    """Amplitude at two cycles per revolution, in the unit of the column."""
    low, high = np.quantile(filled(column.values), [0.005, 0.995])
    return float(abs(order_2(column, angle)) * (high - low) / 2)


def _bridge_unit(column: FileColumn, known: Mapping[str, Any]) -> tuple[str, dict[str, Any], str, str]:
    """Unit of a bridge, what it needs, what of that is not known, and what is in doubt."""
    unit = column.unit
    if unit == STRAIN:
        need = {"gauge_factor": 2.0, "active_arms": 4}
        return unit, {name: known.get(name, usual) for name, usual in need.items()}, _missing(known, need), ""
    if unit in OUTPUTS:
        scale = known.get("full_scale", f"10 {unit} = 2 mV/V")
        return unit, {"full_scale": scale}, _missing(known, ["full_scale"]), ""
    if unit in ("uV", "µV"):
        scale = known.get("full_scale", "10 mV = 2 mV/V")
        return "mV", {"factor": 1e-3, "full_scale": scale}, _missing(known, ["full_scale"]), ""
    if unit in FACTORS["mV/V"]:
        return unit, {}, "", ""
    half = float(np.nanmax(column.values) - np.nanmin(column.values)) / 2
    fits = [unit for unit in ("mV/V", "V/V") if GAUGE_SMALLEST <= half * FACTORS["mV/V"][unit] <= GAUGE_LARGEST]
    return (
        (fits[0], {}, "", f"no unit is said: {fits[0]} by its range") if fits else ("mV/V", {}, "no unit is said", "")
    )


def _missing(known: Mapping[str, Any], need: Any) -> str:
    return ", ".join(name for name in need if name not in known)
