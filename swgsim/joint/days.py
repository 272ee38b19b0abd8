"""Whether friction differs between sessions, as it does with temperature and grease, by more than it can be known."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import f

from swgsim.joint.effects.quadratic_friction import QuadraticFriction
from swgsim.joint.effects.stribeck_friction import StribeckFriction
from swgsim.joint.effects.sublinear_friction import SublinearFriction
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table, solved
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction, Zero

# Terms that are friction by speed alone.
OF_SPEED = (Friction, SublinearFriction, QuadraticFriction, StribeckFriction)
# A session whose friction curve is this near to a constant does not show how it rises with speed.
FLAT = 0.1
# Runs of a session that tell how much runs differ by themselves.
LEAST_RUNS = 3


@dataclass(frozen=True)
class Day:
    """Friction that rises with speed in one session, as a share of that of all sessions.

    Sessions of different speeds are compared by one common curve, so that a curved one does not pass for a difference.

    Attributes
    ----------
    session : str
    share : float
        1 where the session is as all are.
    deviation : float
        Its standard deviation.
    coulomb, zero : float
        Friction that does not rise, and the signal without any, in the unit of the signal. Of a joint that turned one
        way only they cannot be told apart.
    runs : int
        By whose differences the deviation is known.
    """

    session: str
    share: float
    deviation: float
    coulomb: float
    zero: float
    runs: int


@dataclass(frozen=True)
class Days:
    """All sessions.

    Attributes
    ----------
    days : tuple of Day
    chance : float
        Probability of such differences, were all the same.
    """

    days: tuple[Day, ...]
    chance: float

    @property
    def spread(self) -> float:
        """Largest less smallest share."""
        shares = [day.share for day in self.days]
        return max(shares) - min(shares)


def days(top: Fit, tables: Sequence[Table]) -> Days | None:
    """Friction of every session that shows how it rises with speed; None if fewer than two do.

    A session needs three runs, as it is their differences that say how well its friction is known.

    Parameters
    ----------
    top : Fit
        The model.
    tables : sequence of Table
        All recordings, of the fit and held out.
    """
    if not any(isinstance(term, Friction) for term in top.terms):
        return None
    recordings: dict[str, list[JointRecording]] = {}
    for each in (each for table in tables for each in table.recordings):
        recordings.setdefault(each.session, []).append(each)
    found = [_day(name, Table(tuple(own), top.table.of), top.terms) for name, own in sorted(recordings.items())]
    known = tuple(day for day in found if day)
    if len(known) < 2:
        return None
    share, weight = np.array([day.share for day in known]), np.array([day.deviation for day in known]) ** -2.0
    mean = (weight * share).sum() / weight.sum()
    freedom = len(known) - 1, min(day.runs for day in known) - 2
    return Days(known, float(f.sf((weight * (share - mean) ** 2).sum() / freedom[0], *freedom)))


def _day(session: str, table: Table, terms: Sequence[Term]) -> Day | None:
    """Share of one session, its constant friction and its zero being open; None if it does not show it."""
    if len(table.recordings) < LEAST_RUNS:
        return None
    curve = np.concatenate([rising(each, terms) for each in table.recordings])
    sense = np.concatenate([each.sense for each in table.recordings])
    others = [term for term in terms if not isinstance(term, (*OF_SPEED, Zero))]
    left = table.signal - sum(table.columns(term) @ np.array(term.weights) for term in others)
    open_ = np.stack([sense, np.ones(len(sense))], axis=1)
    free = curve - open_ @ solved(open_, curve)
    if free @ free < FLAT**2 * (curve @ curve):
        return None
    share = float(free @ left / (free @ free))
    constant = solved(open_, left - share * curve)
    residual = left - share * curve - open_ @ constant
    # What a run does otherwise than the others of its session is common to all of it.
    runs = len(table.recordings)
    spread = np.sqrt((np.bincount(table.run, free * residual) ** 2).sum() * runs / (runs - 1)) / float(free @ free)
    coulomb, zero = constant.tolist()
    return Day(session, share, float(spread), coulomb, zero, runs)


def rising(recording: JointRecording, terms: Sequence[Term]) -> np.ndarray:
    """Friction that rises with speed, by the model of all sessions."""
    found = np.zeros(len(recording))
    for term in terms:
        if isinstance(term, Friction):
            # Its first column is Coulomb friction, which does not rise.
            term = replace(term, weights=(0.0, *term.weights[1:]))
        if isinstance(term, OF_SPEED):
            found += term.signal(recording)
    return found
