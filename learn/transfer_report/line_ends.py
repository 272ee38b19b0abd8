"""Names of curves at their ends, moved apart where they would cover each other."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb

GREY = "#888888"
NAME_SIZE = 8.5  # points
LINE_HEIGHT = 0.17  # inch


@dataclass(frozen=True)
class End:
    """Where a curve ends, in data coordinates, and its name."""

    text: str
    x: float
    y: float
    colour: str


def spread(heights: Float[np.ndarray, " name"], spacing: float) -> Float[np.ndarray, " name"]:
    """The nearest heights within 0 to 1 that keep a distance from each other, in the same order.

    >>> spread(np.array([0.5, 0.5, 0.9]), 0.1).round(6).tolist()
    [0.45, 0.55, 0.9]
    """
    from scipy.optimize import isotonic_regression

    order = np.argsort(heights, kind="stable")
    steps = min(spacing, 1 / max(len(heights), 1)) * np.arange(len(heights))
    moved = np.empty_like(heights)
    moved[order] = np.clip(isotonic_regression(heights[order] - steps).x, 0, 1 - steps[-1]) + steps
    return moved


def name_ends(axes: Axes, ends: Sequence[End], inside: bool = False) -> None:
    """Names right of the panel, or inside right of the ends, moved apart where they would cover each other.

    The limits of the axes must be final: heights are taken from them.
    """
    if not ends:
        return
    data = np.array([(end.x, end.y) for end in ends])
    fractions = (axes.transScale + axes.transLimits).transform(data)
    column = float(fractions[:, 0].max()) + 0.03 if inside else 1.03
    height_of_panel = axes.bbox.height / axes.figure.dpi
    lines = max(end.text.count("\n") + 1 for end in ends)
    heights = spread(fractions[:, 1].copy(), lines * LINE_HEIGHT / height_of_panel)
    halo = [patheffects.withStroke(linewidth=2.5, foreground="white")]
    for end, height in zip(ends, heights, strict=True):
        dark = tuple(0.75 * part for part in to_rgb(end.colour))  # yellow and light blue are hard to read as text
        axes.annotate(
            end.text, (end.x, end.y), xytext=(column, height), textcoords="axes fraction", va="center",
            fontsize=NAME_SIZE, color=dark, path_effects=halo, zorder=4, annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": end.colour, "linewidth": 0.6, "shrinkA": 1, "shrinkB": 3,
                        "relpos": (0, 0.5)},
        )  # fmt: skip
