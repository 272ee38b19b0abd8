"""Common parts of the pictures of a joint: colours, legends, and stretches of recordings at similar speed."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from jaxtyping import Bool
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from swgsim.joint.recording import SIGNALS, JointRecording
from swgsim.joint.regression import Table
from swgsim.joint.validation import Validation

BEFORE, AFTER, FLOOR, GREY = "#D55E00", "#0072B2", "#000000", "#8c8c8c"
# Width of all pictures [inch]: text is readable on a narrow screen, so panels are stacked.
WIDTH = 6.2
# Colours of sessions; neighbours differ in brightness too.
COLOURS = ("#000000", "#E69F00", "#0072B2", "#009E73", "#D55E00", "#56B4E9")
MARKERS = "os^D"
# Signal names at axes.
SHORT = {"T_sensor": "torque", "current": "current", "T_motor": "motor torque"}
# A motion is in one direction if it ends at least this share of its range away from its start.
ONE_WAY = 0.9
# Classes of speed in each direction of a joint that reverses, and least samples of a class.
CLASSES, FEWEST_SAMPLES = 5, 50
# Letters that fit in a line of a legend.
LINE = 62


def unit(validation: Validation) -> str:
    """Unit of the signal to explain."""
    return SIGNALS[validation.table.of].unit


def one_way(recording: JointRecording) -> bool:
    """Whether the joint turned in one direction only, but for noise."""
    q = recording.signals["q"]
    return bool(abs(q[-1] - q[0]) > ONE_WAY * np.ptp(q))


def tables(validation: Validation) -> tuple[tuple[Table, bool], ...]:
    """Fitted and held-out recordings, each with whether it was held out."""
    return (validation.table, False), (validation.heldout, True)


def pieces(recording: JointRecording) -> Iterator[Bool[np.ndarray, " time"]]:
    """Samples of similar speed: a whole run in one direction, or classes of speed in each direction of a trajectory."""
    if one_way(recording):
        yield np.ones(len(recording), bool)
        return
    speed = recording.speed
    edges = np.linspace(0, np.abs(speed).max(), CLASSES + 2)
    # The lowest class contains the reversals and is left out.
    for low, high in pairwise(edges[1:]):
        for side in (-1, 1):
            chosen = (side * speed > low) & (side * speed <= high)
            if chosen.sum() >= FEWEST_SAMPLES:
                yield chosen


def sessions(validation: Validation) -> dict[str, tuple[str, str]]:
    """Colour and marker of every session."""
    names = sorted({each.session for table, _ in tables(validation) for each in table.recordings})
    return {
        name: (COLOURS[number % len(COLOURS)], MARKERS[number // len(COLOURS) % len(MARKERS)])
        for number, name in enumerate(names)
    }


def session_key(picture: Figure, validation: Validation) -> None:
    """A legend for sessions, and for fitted and held-out recordings."""
    look = sessions(validation)
    names = short(list(look))
    entries = [dot(colour, name, True, marker) for name, (colour, marker) in zip(names, look.values(), strict=True)]
    entries += [dot(GREY, "fitted", False), dot(GREY, "held out", True)]
    columns = max(1, min(len(entries), LINE // (max(map(len, names)) + 6)))
    picture.legend(handles=entries, ncols=columns, loc="outside upper center", fontsize=9)


def dot(colour: str, label: str, filled: bool, marker: str = "o") -> Line2D:
    """An entry of a legend."""
    return Line2D([], [], color=colour, linestyle="", marker=marker, markerfacecolor=face(colour, filled), label=label)


def logarithmic(axis: Axis) -> None:
    """Plain numbers at 1, 2 and 5 of every decade."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FormatStrFormatter("%g"))
    axis.set_minor_formatter(NullFormatter())


def face(colour: str, filled: bool) -> str:
    """Fill of a marker."""
    return colour if filled else "white"


def short(names: Sequence[str]) -> list[str]:
    """Names without their common beginning, up to a separator.

    >>> short(["ur-20_01", "ur-20_02"]), short(["a"])
    (['01', '02'], ['a'])
    """
    common = 0
    if len(names) > 1:
        same = [len(set(letters)) == 1 for letters in zip(*names, strict=False)]
        begin = names[0][: same.index(False) if False in same else 0]
        common = max(begin.rfind(mark) for mark in "_- ") + 1
    return [name[common:] for name in names]
