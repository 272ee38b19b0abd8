"""Figure of the confusion matrix."""

import numpy as np
from matplotlib.figure import Figure

from learn.evaluation.evaluate import Evaluation


def picture(evaluation: Evaluation, title: str) -> Figure:
    """Share of each true class by predicted class, with the numbers of recordings in the cells."""
    confusion = evaluation.confusion
    share = confusion / confusion.sum(axis=1, keepdims=True).clip(min=1)
    names = [name.replace("_", " ") for name in evaluation.classes]
    figure = Figure(figsize=(6.4, 5.4), layout="constrained")
    axes = figure.add_subplot()
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1)
    for (row, column), count in np.ndenumerate(confusion):
        colour = "white" if share[row, column] > 0.5 else "black"
        axes.text(column, row, str(count), ha="center", va="center", color=colour)
    axes.set_xticks(range(len(names)), names, rotation=40, ha="right")
    axes.set_yticks(range(len(names)), names)
    axes.set(xlabel="predicted", ylabel="true", title=title)
    axes.title.set_fontsize("small")
    return figure
