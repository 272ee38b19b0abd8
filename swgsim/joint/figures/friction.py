"""Picture: friction over speed by session."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.common.numbers import NORMAL
from swgsim.joint.days import OF_SPEED, Days, rising
from swgsim.joint.figures.parts import WIDTH, face, pieces, session_key, sessions, short, tables, unit
from swgsim.joint.recording import JointRecording
from swgsim.joint.textbook import Friction, Zero
from swgsim.joint.validation import Validation

# Smaller p-values are not shown as numbers.
SMALLEST_P = 1e-6


def friction(validation: Validation, days: Days) -> Figure:
    """Above: friction at mean speeds, and the curve of every session. Below: its speed-dependent part."""
    picture = style.figure(WIDTH, 6.6)
    over, below = picture.subplots(2, 1, height_ratios=[3, 2])
    look, speeds = sessions(validation), _points(validation, over)
    sense = next(term for term in validation.ladder.top.terms if isinstance(term, Friction)).sense
    for place, day in enumerate(days.days):
        colour, marker = look[day.session]
        low, high = speeds[day.session]
        grid = np.linspace(low, high, 400)
        at = _at(grid)
        curve = day.coulomb * sense(at) + day.zero + day.share * rising(at, validation.ladder.top.terms)
        over.plot(grid, curve, color=colour, linewidth=1.2)
        below.errorbar(place, day.share, yerr=NORMAL * (day.deviation or 0.0), color=colour, marker=marker, capsize=4)
    below.set_xticks(
        range(len(days.days)), short([day.session for day in days.days]), rotation=30, ha="right", fontsize=8
    )
    below.set_xlim(-0.6, len(days.days) - 0.4)
    style.label(over, "speed of the joint [rad/s]", f"friction [{unit(validation)}]")
    style.label(
        below,
        "",
        "relative to all sessions",
        "speed-dependent friction" + ("" if days.chance is None else f", p-value {_chance(days.chance)}"),
    )
    session_key(picture, validation)
    return picture


def _at(speeds: np.ndarray) -> JointRecording:
    """A recording of a joint at these speeds."""
    return JointRecording("", "", "", "", 0.01 * np.arange(len(speeds)), {"q": np.zeros(len(speeds)), "omega": speeds})


def _chance(value: float) -> str:
    return f"{value:.1g}" if value >= SMALLEST_P else f"below {SMALLEST_P:g}"


def _points(validation: Validation, axes: Axes) -> dict[str, tuple[float, float]]:
    """Draw friction at mean speeds; return the lowest and the highest speed of every session."""
    others = [term for term in validation.ladder.top.terms if not isinstance(term, (*OF_SPEED, Zero))]
    look = sessions(validation)
    found: dict[str, tuple[float, float]] = {}
    for table, heldout in tables(validation):
        rest = table.signal - sum(table.columns(term) @ np.array(term.weights) for term in others)
        for number, each in enumerate(table.recordings):
            own, (colour, marker) = rest[table.run == number], look[each.session]
            for chosen in pieces(each):
                speed = float(each.speed[chosen].mean())
                shown = face(colour, heldout)
                axes.plot(speed, own[chosen].mean(), color=colour, marker=marker, markerfacecolor=shown, markersize=5)
                low, high = found.get(each.session, (0.0, 0.0))
                found[each.session] = min(low, speed), max(high, speed)
    return found
