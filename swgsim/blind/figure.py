"""The score as a picture: rates with intervals, and the error after over the oracle's by strength."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from swgsim.blind.scored_case import ScoredCase
from swgsim.blind.table import ROWS
from swgsim.common.style import figure, label, png

COLOURS = ("#000000", "#999999", "#0072B2", "#E69F00", "#009E73")


def picture(cases: Sequence[ScoredCase], found: Mapping[str, Any]) -> bytes:
    """PNG of the score."""
    drawn = figure(11, 4.5)
    left, right = drawn.subplots(1, 2)
    _rates(left, found)
    _errors(right, cases)
    return png(drawn)


def _rates(axes: Any, found: Mapping[str, Any]) -> None:
    methods = {"loop": found, **found["baselines"]}
    rows = [key for key in ROWS if key != "after_over_oracle_median"]
    named: set[str] = set()
    for number, (name, method) in enumerate(methods.items()):
        for row, key in enumerate(rows):
            value = method[key]
            if value["value"] is None:
                continue
            below, above = value["value"] - value["low"], value["high"] - value["value"]
            axes.errorbar(
                value["value"], row + 0.15 * (number - 2), xerr=[[max(below, 0)], [max(above, 0)]], fmt="o",
                color=COLOURS[number], label=None if name in named else name.replace("_", " "),
            )  # fmt: skip
            named.add(name)
    axes.set_yticks(range(len(rows)), [ROWS[key] for key in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlim(-0.03, 1.03)
    if named:
        axes.legend(fontsize=8, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    label(axes, "share of cases, with 95 % interval", "", "Identification and simpler methods")


def _errors(axes: Any, cases: Sequence[ScoredCase]) -> None:
    known = [case for case in cases if case.known and not case.failed]
    strength = [min(case.case.strengths) for case in known]
    for first, colour, text in (("before", "#999999", "before"), ("after", "#D55E00", "after")):
        axes.plot(strength, [case.over(first, "oracle") for case in known], "o", color=colour, label=text)
    axes.axhline(1, color="#000000", linewidth=0.8)
    if known:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlim(0.7 * min(strength), 1.4 * max(np.max(strength), 1))
        axes.legend(fontsize=8)
    label(
        axes,
        "strength of the hidden effect (non-centrality)",
        "error relative to the true model",
        "Error at operating points that were not recorded",
    )
