"""Picture of how unlike the others gears are, and whether it goes along with the error on them."""

from learn.transfer_report.novelty import Novelty
from swgsim.common import style

USUAL, FOREIGN = "#0072B2", "#D55E00"


def novelty_beside_error(novelty: Novelty, method: str) -> style.Picture:
    """Error of every judged gear against its novelty, with the novelty of foreign gears as strokes."""
    picture = style.figure(7, 4.2)
    axes = picture.add_subplot()
    for number, value in enumerate([] if novelty.foreign is None else novelty.foreign):
        axes.axvline(value, color=FOREIGN, linewidth=1.2, label=None if number else "gears of grid=far")
    axes.plot(novelty.usual["novelty"], novelty.usual["error"], "o", color=USUAL, label="judged gears, left out")
    axes.axvline(novelty.threshold, color="#888888", linewidth=1, linestyle=":", label="largest of the judged gears")
    axes.set(ylim=(0, None))
    if novelty.foreign is not None:
        axes.set_xscale("log")
    style.label(axes, "novelty of the healthy reference [-]", "error [%]")
    picture.legend(loc="outside lower center", ncols=3, fontsize=9)
    return style.Picture(
        "Does a gear show that it is not known?",
        f"Each dot is a judged gear: how far its healthy reference lies from those of the others, and the error of "
        f"{method} on it. Look for strokes right of the dotted line, gears that show before any fault that they are of "
        "another population; and for dots that rise to the right, gears that warn of errors.",
        style.png(picture),
    )
