"""Numbers that the same commands made twice, beside one another."""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

Numbers = Mapping[str, np.ndarray]  # "kind/what/of what" to values
Row = dict[str, Any]


class Tolerance(NamedTuple):
    """How far numbers of a kind may lie apart, of what, and why."""

    limit: float
    of: str
    reason: str


TOLERANCES = {
    "signals": Tolerance(2e-7, "of the largest signal", "files hold float32, which resolves 6e-8: another last bit"),
    "facts": Tolerance(1e-12, "of the largest value", "float64, which resolves 1e-16: sums in another order"),
    "features": Tolerance(1e-3, "of the feature's range", "eq. 7 divides by as little as 1e-6 mV/V: a last bit grows"),
    "metrics": Tolerance(2.0, "points", "a recording at a border of classes may fall on its other side"),
}


def compared(ours: Numbers, theirs: Numbers) -> list[Row]:
    """The largest difference of every kind and what it is of, as its tolerance measures it, and where it is.

    Raises
    ------
    ValueError
        If one of the two has numbers that the other has not; it names them.
    """
    if missing := set(ours) ^ set(theirs):
        raise ValueError(f"only one of the two has {', '.join(sorted(missing))}; both must run the same commands")
    rows: dict[tuple[str, str], Row] = {}
    for name in ours:
        kind, what, of_what = name.split("/", 2)
        row = rows.setdefault((kind, what), {"kind": kind, "what": what, "values": 0, "differing": 0, "difference": -1})
        a, b = ours[name], theirs[name]
        if a.shape != b.shape or (np.isnan(a) != np.isnan(b)).any():
            raise ValueError(
                f"{name}: shapes {a.shape} and {b.shape}, or NaN in different places; both must be the same"
            )
        row["values"] += a.size
        row["differing"] += int((a != b).sum() - np.isnan(a).sum())
        difference = apart(kind, a, b)
        if difference > row["difference"]:
            row |= {"difference": difference, "where": of_what, "within": difference <= TOLERANCES[kind].limit}
    return list(rows.values())


def apart(kind: str, a: np.ndarray, b: np.ndarray) -> float:
    """The largest difference in the measure of the kind's tolerance; of whole numbers, how many are not the same."""
    if a.dtype.kind != "f":
        return float((a != b).sum())
    if kind == "metrics":
        measure = np.ones(1)
    elif kind == "features":
        measure = np.ptp(a, axis=0)
    else:
        measure = np.nan_to_num(np.abs(a)).max(keepdims=True)
    differences = np.nan_to_num(np.abs(a.astype(float) - b))
    return float((differences / np.where(measure > 0, measure, 1)).max())


def table(rows: Iterable[Row]) -> str:
    """The rows to read."""
    lines = [
        "| numbers | values | not the same | largest difference | tolerance | where |",
        "|---|--:|--:|--:|---|---|",
    ]
    for row in rows:
        tolerance = TOLERANCES[row["kind"]]
        cells = [row["values"], row["differing"], f"{row['difference']:.1e}", f"{tolerance.limit:g} {tolerance.of}"]
        lines.append(f"| {row['kind']}, {row['what']} | {' | '.join(map(str, cells))} | {row['where']} |")
    return "\n".join(lines)


def beyond(rows: Iterable[Row]) -> list[str]:
    """What differs by more than its tolerance, in words."""
    return [
        f"{row['kind']}, {row['what']}: {row['where']} by {row['difference']:.1e}, at most "
        f"{TOLERANCES[row['kind']].limit:g} {TOLERANCES[row['kind']].of} is expected"
        for row in rows
        if not row["within"]
    ]
