"""Pictures of transfer to new gears, with the captions that say where to look."""

from typing import NamedTuple

import pandas as pd
from matplotlib.figure import Figure

from learn.transfer_report import curve_figures, map_figures
from swgsim.common import style


class Words(NamedTuple):
    """Title and caption of a picture, whatever its numbers."""

    title: str
    caption: str


SHOTS = Words(
    "What labelled variants of a new gear are worth",
    "Error on new gears with its 95 % interval against the labelled variants given of each class. Look where a "
    "curve falls below the dashed lines (known without any label) and how many labels the grey curve, trained on "
    "the new gear alone, needs to get as low: that many are saved by transfer.",
)
SIZE = Words(
    "Does a smaller model carry over better?",
    "Accuracy on the gears of the training (dashed) and on a gear never seen (solid) against the model's size, one "
    "colour per setting. Look at the gap below: if it grows to the right while the solid lines fall, large models "
    "learn the gear instead of the fault.",
)
SPECTRUM = Words(
    "On which orders the disturbance and the faults lie",
    "Mean amplitude at the multiples of the wave generator's speed, on a logarithmic scale. Look where the grey "
    "bars are high and where faults rise above healthy (even orders are shaded): where only the faults do, a "
    "feature sees the fault and not the disturbance.",
)


def picture(words: Words, drawn: Figure) -> style.Picture:
    """A figure below its title and above its caption."""
    return style.Picture(*words, style.png(drawn))


def forgotten_against_shots(curves: pd.DataFrame) -> style.Picture:
    """Forgetting against labelled variants; the parameter is that of :func:`.curve_figures.forgotten`."""
    drawn = curve_figures.forgotten(curves)
    limit = curve_figures.FORGOTTEN_LIMIT
    most = curves.groupby("method")["forgotten"].max().dropna()
    return style.Picture(
        "What adapting to one gear costs on the others",
        f"Accuracy that the adapted model loses on the source gears. Look for curves above the dashed line: "
        f"{(most > limit).sum()} of {len(most)} methods lose more than {limit:g} points somewhere, and their adapted "
        "models serve one gear only.",
        style.png(drawn),
    )


def inputs_map(inputs: pd.DataFrame) -> style.Picture:
    """Error of all inputs and methods; the parameter is that of :func:`learn.transfer_report.map_figures.inputs`."""
    drawn = map_figures.inputs(inputs)
    best = inputs.sort_values("error").iloc[0]
    return style.Picture(
        "Which input a new gear needs",
        f"Error on new gears of every input and method; two marks of a row differ only in whether the efficiency is "
        f"given. The least error is that of {style.words(str(best['input']))} with {best['method']} "
        f"({best['error']:.1f} %); look how long the bars are: so much hangs on the efficiency.",
        style.png(drawn),
    )


def where_transfer_pays(scenarios: pd.DataFrame) -> style.Picture:
    """Gains and losses in every scenario; the parameter is that of :func:`learn.transfer_report.map_figures.pays`."""
    drawn = map_figures.pays(scenarios)
    rows = map_figures.beside_from_scratch(scenarios.dropna(subset=["error"]))
    worse = int((rows["error"] > rows["unadapted"]).sum())
    behind = int((rows["error"] > rows["scratch"]).sum())
    return style.Picture(
        "Where transfer pays and where it does not",
        f"Every bar leads from the error without adaptation to that with it; differences are in points. Look for "
        f"orange, pointing right ({worse} of {len(rows)} rows): adapting does harm there; and for crosses left of the "
        f"triangle ({behind}): training on the new gear alone is better than any help of other gears.",
        style.png(drawn),
    )
