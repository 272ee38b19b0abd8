"""The picture of the study: scores of every undeclared effect before and after the loop, and of the oracle."""

from collections.abc import Sequence

import matplotlib.figure
import numpy as np

from learn.sim_to_real.judging import DAYS, MODELS
from learn.sim_to_real.verdicts import Finished, row_of
from swgsim.common.style import Picture, figure, label, png, words

COLOURS = {"before": "#D55E00", "after": "#0072B2", "oracle": "#000000"}
LEGEND = {"before": "before the loop", "after": "after the loop", "oracle": "effect known"}
TITLES = {"commissioning": "references before the effect came", "same day": "references with the effect"}
SCORES = {"accuracy": "accuracy [%]", "false_alarms": "false alarms [%]"}


def picture(finished: Sequence[Finished], method: str) -> Picture:
    """Accuracy and false alarms of a method."""
    return Picture(
        title=words(method).capitalize(),
        caption=(
            "One gear; lines are 95 % intervals over fault variants and healthy states. Left: each recording is set in "
            "relation to references that were recorded before the effect came; right: to references with the effect."
        ),
        png=png(drawn(finished, method)),
    )


def drawn(finished: Sequence[Finished], method: str) -> matplotlib.figure.Figure:
    """One row per score, one column per day of the references."""
    shown = figure(11.5, 1.6 + 0.62 * len(finished))
    axes = shown.subplots(1, 2 * len(SCORES), sharey=True)
    rows = np.arange(len(finished))
    panels = [(score, day) for day in DAYS for score in SCORES]
    for here, (score, day) in zip(axes, panels, strict=True):
        for number, model in enumerate(MODELS):
            parts = [row_of(each.scores, method, day, model) for each in finished]
            values, low, high = (
                np.array([part[f"{score}{end}"] for part in parts], dtype=float) for end in ("", "_low", "_high")
            )
            at = rows + 0.22 * (number - 1)
            here.hlines(at, low, high, color=COLOURS[model], linewidth=1.4)
            here.plot(values, at, "o", color=COLOURS[model], markersize=4.5, label=LEGEND[model])
        label(here, SCORES[score], "", TITLES[day] if score == "accuracy" else "")
        here.set_xlim(-3, 103)
    axes[0].set_yticks(rows, [words(each.name) for each in finished])
    axes[0].invert_yaxis()
    shown.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(MODELS), frameon=False)
    return shown
