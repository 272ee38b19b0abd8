"""Picture: error of the textbook model and after each accepted effect."""

from collections.abc import Mapping
from textwrap import fill
from typing import Any

from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.figures.parts import AFTER, FLOOR, WIDTH

# Letters in a line of a name.
LETTERS = 26


def rungs(report: Mapping[str, Any]) -> Figure:
    """Error of every accepted model on the fitted and on the held-out recordings."""
    kept = [rung for rung in report["rungs"] if rung["kept"]]
    names = [fill(("+ " if i else "") + rung["title"], LETTERS) for i, rung in enumerate(kept)]
    lines = sum(name.count("\n") + 1 for name in names)
    picture = style.figure(WIDTH, 1.5 + 0.17 * lines + 0.12 * len(kept))
    axes = picture.subplots()
    places = [-float(i) for i in range(len(kept))]
    fitted, heldout = ([rung[which] for rung in kept] for which in ("fit", "heldout"))
    axes.plot(fitted, places, "o", color="#56B4E9", markerfacecolor="white", label="fitted recordings")
    axes.plot(heldout, places, drawstyle="steps-post", color=AFTER, linewidth=1.2)
    axes.plot(heldout, places, "o", color=AFTER, label="held-out recordings")
    for place, value in zip(places, heldout, strict=True):
        axes.annotate(f"{value:#.3g}", (value, place), (4, 4), textcoords="offset points", fontsize=8, ha="left")
    if report["noise_floor"] is not None:
        axes.axvline(report["noise_floor"], color=FLOOR, linestyle="--", label="noise at rest")
    axes.set_yticks(places, names, fontsize=9)
    axes.set_ylim(-len(kept) + 0.4, 0.6)
    axes.set_xlim(0, 1.15 * max(fitted + heldout))
    style.label(axes, f"rms error [{report['unit']}]", "")
    picture.legend(*axes.get_legend_handles_labels(), ncols=2, loc="outside upper center", fontsize=9)
    return picture
