"""A picture of a draft: one panel for each column of numbers, against time."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.drafting.clock import ClockDraft
from swgsim.drafting.draft_line import DraftLine

# Panels beside one another, and samples that are drawn of each column.
BESIDE = 3
DRAWN = 5000
# Most panels: those of six joints with all that a controller logs.
MOST_PANELS = 60


def picture(drafted: Sequence[DraftLine], clock: ClockDraft | None) -> Figure:
    """Draw all columns; those that are not read are grey."""
    numbers = [each for each in drafted if each.quantity not in ("t", "gear_ratio") and not each.column.is_text]
    shown = numbers[:MOST_PANELS]
    rows = max(-(-len(shown) // BESIDE), 1)
    figure = style.figure(4.2 * BESIDE, 1.9 * rows)
    panels = figure.subplots(rows, BESIDE, squeeze=False).ravel()
    for axes, each in zip(panels, shown, strict=False):
        values = each.column.values
        time = clock.time - clock.time[0] if clock is not None else np.arange(len(values))
        step = max(len(values) // DRAWN, 1)
        colour = style.SENSOR_COLOURS.get(each.quantity, "#0072B2") if each.quantity else "#999999"
        axes.plot(time[::step], values[::step], color=colour, linewidth=0.8)
        name = " ".join(filter(None, [each.joint, each.quantity])) or "not read"
        unit = each.entry.get("unit", each.column.unit)
        style.label(
            axes,
            "time [s]" if clock is not None else "sample",
            f"[{unit}]" if unit else "",
            f"{name}: {each.column.column}".replace("$", r"\$"),  # no formula
        )
    for axes in panels[len(shown) :]:
        axes.set_visible(False)
    return figure
