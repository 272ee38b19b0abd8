"""Pictures of the answer for a joint: ladder, measured and predicted signals, residual, effects."""

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.days import Days
from swgsim.joint.figures.friction import friction
from swgsim.joint.figures.rungs import rungs
from swgsim.joint.figures.stretches import stretches
from swgsim.joint.figures.unexplained import unexplained
from swgsim.joint.figures.waves import waves
from swgsim.joint.remaining import RemainingLine
from swgsim.joint.validation import Validation

LADDER = (
    "Error after each effect",
    "Each row adds one effect to all rows above it. Blue: error on held-out recordings, which fit and selection did "
    "not use. Open rings: error on fitted recordings. Where blue moves to the right, the effect does not help on "
    "recordings not seen.",
)
STRETCHES = (
    "Measured and predicted on held-out recordings",
    "Black: measured; orange: textbook model; blue: model with all effects found. Below each recording is a close-up "
    "of its grey band: the same signal for a run in one direction, measured minus predicted for a joint that reverses. "
    "Where blue differs from black, or from zero, an effect is still missing.",
)
WAVES = (
    "Amplitude and phase of the ripples",
    "Points: least-squares estimates in every recording, after all other effects were subtracted; bars: noise, from "
    "neighbouring orders. Line: model. A maximum shows a resonance, a fall a filter. If the phases of sessions agree, "
    " the ripple is fixed to the gear and can be compensated. Phases are drawn for amplitudes of at least twice "
    "the noise; those of backward motion are mirrored, like a lag.",
)
FRICTION = (
    "Friction by session",
    "Above: the signal without all effects that are not friction by speed, averaged over stretches of similar speed, "
    "with the friction curve of each session. Below: speed-dependent friction of each session relative to all, with "
    "95 % intervals. If they do not overlap, friction changed between sessions; the recordings do not show why.",
)
UNEXPLAINED = (
    "Lines that no effect explains",
    "Each dot is a significant line in the residual of a recording at steady speed; larger dots are stronger. A "
    "straight line through the origin is a wave fixed to the gear. A level line has a fixed frequency, such as an "
    "electric disturbance or a resonance. A falling line is an alias of sampling.",
)


def pictures(
    validation: Validation, days: Days | None, lines: Sequence[RemainingLine], report: Mapping[str, Any]
) -> dict[str, tuple[style.Picture, Figure]]:
    """All pictures by their names, without empty ones.

    Parameters
    ----------
    validation : Validation
    days : Days or None
        Friction by session, if known.
    lines : sequence of RemainingLine
        Lines that remain in the residual.
    report : mapping
        Result of :func:`swgsim.joint.report.report`.
    """
    drawn = {
        "ladder": (*LADDER, rungs(report)),
        "stretches": (*STRETCHES, stretches(validation)),
        "waves": (*WAVES, waves(validation)),
        "friction": (*FRICTION, friction(validation, days) if days else None),
        "unexplained": (*UNEXPLAINED, unexplained(validation, lines) if lines else None),
    }
    return {
        name: (style.Picture(title, caption, style.png(figure)), figure)
        for name, (title, caption, figure) in drawn.items()
        if figure is not None
    }
