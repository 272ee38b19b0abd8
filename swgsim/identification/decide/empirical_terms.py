"""Patches: regularities without a cause, in the model where they hold wherever the recordings can try them."""

from dataclasses import replace

from swgsim.effects.quantity import beyond_nothing
from swgsim.effects.regularity import LAWS, OF_TEMPERATURE, OF_TIME
from swgsim.identification.decide.candidate import gained
from swgsim.identification.decide.selection import Closed
from swgsim.identification.fit.errors import Errors, of_points_left_out, relative
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended
from swgsim.identification.fit.form_error import LEAST_GAIN

# Share of its size that an effect found must keep beside a patch; one that takes it away says the same once more.
KEPT = 0.5
# Times what it was that the error at an operating point left out may become: much of it is that of zeros, and luck. Of
# all points together, as the report has it, it may become hardly larger.
WORSE, WORSE_TOGETHER = 2.0, 1.05


def patched(closed: Closed) -> Closed:
    """With those unknown regularities in the model too that hold at operating points which they were not fitted to.

    One that may follow the temperature, or the time, or another law as well is none of them: what rises together in one
    session parts in the next. Nor is one that takes away what an effect was found for. Of laws that explain it alike
    the simplest is taken: a root, a line and a square through two loads lie far apart between them.
    """
    found = closed.after
    if len(found.predictive) < 2:
        return closed  # no operating point can be left out
    for each in closed.unknown:
        if each.rivals and {each.atom.law, *each.rivals} & {OF_TEMPERATURE, OF_TIME}:
            continue
        simplest = min((each.atom.law, *each.rivals), key=list(LAWS).index)
        fitted = extended(closed.after, [replace(each.effect, law=simplest)])
        if fitted.calibrated.settled and _spares(closed.after, fitted) and _holds(found, closed.after, fitted):
            closed = replace(closed, after=fitted)
    return closed


def _spares(before: Fitted, after: Fitted) -> bool:
    """Whether every effect that was found keeps most of its size."""
    both = zip(before.added, after.added, strict=False)
    return all(abs(beyond_nothing(now)) >= KEPT * abs(beyond_nothing(was)) for was, now in both)


def _holds(found: Fitted, before: Fitted, after: Fitted) -> bool:
    """Whether it pays on operating points left out, makes none of them clearly worse, and all together not worse than
    without any patch.
    """
    gains, _ = gained(before, after)
    pays = gains.sum() > LEAST_GAIN and gains.min() > -LEAST_GAIN
    if not pays or (of_points_left_out(after) > WORSE * of_points_left_out(before)).any():
        return False
    now, was = (relative(after.measured, Errors(fitted, after).heldout) for fitted in (after, found))
    return now <= WORSE_TOGETHER * was
