"""Picture: measured and predicted signals of some held-out recordings, and close-ups."""

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.figures.parts import AFTER, BEFORE, FLOOR, SHORT, WIDTH, one_way, unit
from swgsim.joint.recording import JointRecording
from swgsim.joint.validation import Validation

SHOWN_STRETCHES = 3
# Waves of the strongest fast ripple in a close-up, least fast order, and share of a recording without a fast ripple.
CLOSE_WAVES, FAST, CLOSE_UP_SHARE = 12, 40, 0.1
# Largest share of a recording in a close-up.
LARGEST_CLOSE_UP = 0.4
# Share in a close-up around a reversal.
REVERSAL_SHARE = 0.25
# A step of the angle by this share of its range is a jump.
JUMP = 0.02
# Colours, names and widths of the measured signal and of both models.
LOOK = ((FLOOR, "measured", 0.7), (BEFORE, "textbook model", 1.4), (AFTER, "with the effects found", 1.2))


def stretches(validation: Validation) -> Figure:
    """A slow, a middle and a fast held-out recording."""
    recordings = validation.heldout.recordings
    by_speed = sorted(range(len(recordings)), key=lambda number: float(np.abs(recordings[number].speed).mean()))
    middle = np.linspace(0, len(by_speed) - 1, min(SHOWN_STRETCHES, len(by_speed))).round().astype(int)
    picture = style.figure(WIDTH, 4.2 * len(middle) + 0.4)
    panels = picture.subplots(2 * len(middle), 1).reshape(-1, 2)
    measured = validation.heldout.signal
    residuals = [fit.missed(validation.heldout) for fit in (validation.ladder.textbook, validation.ladder.top)]
    for (whole, close), number in zip(panels, [by_speed[i] for i in middle], strict=True):
        own, each = validation.heldout.run == number, recordings[number]
        curves = [measured[own], *(measured[own] - missed[own] for missed in residuals)]
        x, name = _along(each)
        chosen = _close(validation, each)
        _draw(whole, x, curves)
        whole.axvspan(np.nanmin(x[chosen]), np.nanmax(x[chosen]), color="#dddddd", zorder=0)
        if one_way(each):
            _draw(close, x[chosen], [curve[chosen] for curve in curves])
        else:
            for missed, (colour, _, width) in zip(residuals, LOOK[1:], strict=True):
                close.plot(x[chosen], missed[own][chosen], color=colour, linewidth=width)
            close.axhline(0, color=FLOOR, linewidth=0.7)
            close.margins(x=0)
        speed = float(np.abs(each.speed).mean())
        style.label(
            whole,
            name,
            f"{SHORT[validation.table.of]} [{unit(validation)}]",
            f"{each.name}, {speed:.2g} rad/s on average",
        )
        signal = f"{SHORT[validation.table.of]} [{unit(validation)}]"
        style.label(close, name, signal, "close-up" if one_way(each) else "close-up: measured minus predicted")
    picture.legend(*panels[0, 0].get_legend_handles_labels(), ncols=3, loc="outside upper center", fontsize=9)
    return picture


def _along(recording: JointRecording) -> tuple[Float[np.ndarray, " time"], str]:
    """Horizontal axis of a recording."""
    if one_way(recording):
        q = recording.signals["q"]
        # The curve is interrupted where rows are missing.
        jumps = np.abs(np.diff(q, prepend=q[0])) > JUMP * np.ptp(q)
        return np.where(jumps, np.nan, np.rad2deg(q)), "angle of the joint [degrees]"
    return recording.time - recording.time[0], "time [s]"


def _close(validation: Validation, recording: JointRecording) -> slice:
    """A stretch in which single waves are visible, or around a reversal."""
    number = len(recording)
    fast = [step.term for step in validation.ladder.steps if isinstance(step.term, Ripple) and step.term.order > FAST]
    if not one_way(recording):
        length = int(REVERSAL_SHARE * number)
        turns = np.flatnonzero(np.diff(np.sign(recording.speed)))
        centre = int(turns[np.argmin(np.abs(turns - number / 2))]) if len(turns) else number // 2
    else:
        wanted = CLOSE_WAVES * 2 * np.pi / fast[0].order if fast else 0.0
        span = float(np.ptp(recording.signals["q"]))
        length = int(number * min(wanted / span or CLOSE_UP_SHARE, LARGEST_CLOSE_UP))
        centre = number // 2
    length = min(number, max(length, 10))
    begin = min(max(centre - length // 2, 0), number - length)
    return slice(begin, begin + length)


def _draw(axes: Axes, x: np.ndarray, curves: list[np.ndarray]) -> None:
    for curve, (colour, label, width) in zip(curves, LOOK, strict=True):
        axes.plot(x, curve, color=colour, linewidth=width, label=label)
    axes.margins(x=0)
