"""Picture: error of every recording, before and after."""

from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from swgsim.common import style
from swgsim.joint.figures.parts import AFTER, BEFORE, FLOOR, dot, face, logarithmic, steady
from swgsim.joint.judged import Judged


def runs(judged: Judged, said: Mapping[str, Any]) -> Figure:
    """Over the speed of runs in one direction; trajectories one below the other."""
    found = said["runs"]
    moving = steady(judged)
    picture = style.figure(11, 4.4 if moving else 1.4 + 0.3 * len(found))
    axes = picture.subplots()
    error = f"error [{said['unit']}]"
    for number, run in enumerate(found):
        place = run["speed"] if moving else -number
        ends, width = [run["before"], run["after"]], 0.8
        axes.plot(*_turned([place, place], ends, moving), color="#bbbbbb", linewidth=width, zorder=1)
        for value, colour in zip(ends, (BEFORE, AFTER), strict=True):
            shown = face(colour, run["heldout"])
            axes.plot(*_turned([place], [value], moving), "o", color=colour, markerfacecolor=shown, markersize=6)
    if said["noise_floor"] is not None:
        (axes.axhline if moving else axes.axvline)(said["noise_floor"], color=FLOOR, linestyle="--")
    if moving:
        axes.set_xscale("log")
        logarithmic(axes.xaxis)
        axes.set_ylim(bottom=0)
        style.label(axes, "mean speed of the joint [rad/s]", error)
    else:
        axes.set_yticks([-i for i in range(len(found))], [run["run"] for run in found], fontsize=8)
        axes.set_xlim(left=0)
        axes.set_ylim(0.6 - len(found), 0.6)
        style.label(axes, error, "")
    key = [
        dot(BEFORE, "textbook model", True), dot(AFTER, "with the effects found", True),
        dot("#555555", "fitted", False), dot("#555555", "held out", True),
    ]  # fmt: skip
    if said["noise_floor"] is not None:
        key.append(Line2D([], [], color=FLOOR, linestyle="--", label="noise at rest"))
    picture.legend(handles=key, ncols=len(key), loc="outside upper center")
    return picture


def _turned(places: list[float], values: list[float], upright: bool) -> tuple[list[float], list[float]]:
    """Errors upwards over speeds, or to the right beside names."""
    return (places, values) if upright else (values, places)
