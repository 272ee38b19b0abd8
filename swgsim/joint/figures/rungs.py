"""Picture: the ladder, rung by rung."""

from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.figures.parts import AFTER, FLOOR, GREY


def rungs(said: Mapping[str, Any]) -> Figure:
    """Error of every rung on what was fitted and on what was held out; refused effects in grey below."""
    kept = [rung for rung in said["rungs"] if rung["kept"]]
    refused = [rung for rung in said["rungs"] if not rung["kept"]]
    picture = style.figure(11, 1.3 + 0.27 * (len(kept) + len(refused)))
    axes = picture.subplots()
    places = [-float(i) for i in range(len(kept))]
    axes.plot(
        [r["fit"] for r in kept], places, "o", color="#56B4E9", markerfacecolor="white", label="fitted recordings"
    )
    heldout = [r["heldout"] for r in kept]
    axes.plot(heldout, places, drawstyle="steps-post", color=AFTER, linewidth=1.2)
    axes.plot(heldout, places, "o", color=AFTER, label="held-out recordings")
    for place, value in zip(places, heldout, strict=True):
        axes.annotate(f"{value:#.3g}", (value, place), (4, 4), textcoords="offset points", fontsize=7, ha="left")
    if refused:
        below = [-len(kept) - 0.6 - i for i in range(len(refused))]
        axes.plot(
            [r["heldout"] for r in refused], below, "D", color=GREY, markersize=4.5, label="held-out, effect refused"
        )
        axes.axhline(-len(kept) + 0.2, color=GREY, linewidth=0.8)
        places = places + below
    if said["noise_floor"] is not None:
        axes.axvline(said["noise_floor"], color=FLOOR, linestyle="--", label="noise at rest")
    names = [("+ " if i else "") + rung["title"] for i, rung in enumerate(kept)] + [rung["title"] for rung in refused]
    axes.set_yticks(places, names, fontsize=8)
    for tick in axes.get_yticklabels()[len(kept) :]:
        tick.set_color("#666666")
    axes.set_xlim(0, 1.08 * max([r["fit"] for r in kept] + [r["heldout"] for r in said["rungs"]]))
    style.label(axes, f"error: root mean square of measured less predicted [{said['unit']}]", "")
    picture.legend(*axes.get_legend_handles_labels(), ncols=4, loc="outside upper center")
    return picture
