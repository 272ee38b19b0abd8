"""Pictures of the answer for a joint: the ladder, what was measured, what is left over, where effects were found."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.days import Days
from swgsim.joint.figures.friction import friction
from swgsim.joint.figures.rungs import rungs
from swgsim.joint.figures.runs import runs
from swgsim.joint.figures.spectrum import spectrum
from swgsim.joint.figures.stretches import stretches
from swgsim.joint.figures.unexplained import unexplained
from swgsim.joint.figures.waves import waves
from swgsim.joint.judged import Judged
from swgsim.joint.remaining import RemainingLine

LADDER = (
    "What each effect bought",
    "From the textbook model downwards, every row adds one effect to all those above it. Blue is the error on held-out "
    "recordings, which nothing was fitted to and nothing was chosen by; the open ring is the error on those that were "
    "fitted. Grey: effects that were tried on top of the last model and refused, with the error they would have led "
    "to. What is kept is decided within the fitted recordings, so a grey point may lie left of the last blue one.",
)
STRETCHES = (
    "Measured and predicted on held-out recordings",
    "Black is measured, orange the textbook model, blue the model with all effects found. Left a whole run, right "
    "the part of it in the grey band: the same signal of a run in one direction, measured less predicted of one that "
    "moves to and fro. Where blue does not follow black, or is not at zero, something is still missing.",
)
SPECTRUM = (
    "What is left over, by frequency",
    "Measured less predicted, over all held-out recordings. Friction, gravity and inertia act at the left, ripples "
    "further right. The dashed line is the noise at rest, if recorded, as if it were the same at all frequencies.",
)
RUNS = (
    "Error of every recording",
    "Each recording before (orange) and after (blue). Filled: held out; open: fitted. The dashed line, if any, is the "
    "noise of the signal at rest, which no model can beat. The model still lacks something where blue is far above it.",
)
WAVES = (
    "Amplitude and phase of the ripples",
    "Points are measured in every recording by least squares, after all other effects were taken out; the bar is what "
    "neighbouring orders have, which is noise. The line is the model. A hump shows a resonance, a fall a filter. Where "
    "the points of different sessions agree in phase, the ripple is fixed to the gear and may be compensated. Phases "
    "are drawn where the ripple is at least twice its noise; those of backward motion are mirrored, as a lag is.",
)
FRICTION = (
    "Friction by session",
    "Left: the signal less all effects that are not friction by speed, averaged over stretches of like speed, with the "
    "friction curve of each session: that of all sessions, its rising part scaled. Right: by how much, with 95 % "
    "intervals. Where they do not overlap, friction changed between sessions; the recordings do not say why.",
)
UNEXPLAINED = (
    "Lines that no effect explains",
    "Every dot is a line above 5 Hz in what is left over of a recording in one direction, the larger the stronger. A "
    "straight line through the origin is a wave fixed to the gear; a level one has a frequency of its own, as an "
    "electric disturbance or a structure has; a falling one is an image made by sampling.",
)


def pictures(
    judged: Judged, days: Days | None, lines: Sequence[RemainingLine], said: Mapping[str, Any]
) -> dict[str, tuple[style.Picture, Figure]]:
    """All pictures by their names; those that have nothing to show are left out.

    Parameters
    ----------
    judged : Judged
    days : Days or None
        Friction by session, if it can be told.
    lines : sequence of RemainingLine
        What is left over.
    said : mapping
        As :func:`swgsim.joint.report.report` makes it.
    """
    drawn = {
        "ladder": (*LADDER, rungs(said)),
        "stretches": (*STRETCHES, stretches(judged)),
        "spectrum": (*SPECTRUM, spectrum(judged)),
        "runs": (*RUNS, runs(judged, said)),
        "waves": (*WAVES, waves(judged)),
        "friction": (*FRICTION, friction(judged, days) if days else None),
        "unexplained": (*UNEXPLAINED, unexplained(judged, lines) if lines else None),
    }
    return {
        name: (style.Picture(title, caption, style.png(figure)), figure)
        for name, (title, caption, figure) in drawn.items()
        if figure is not None
    }
