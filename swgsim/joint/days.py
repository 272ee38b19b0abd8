"""Friction by session, which changes with temperature and grease, and the significance of the differences."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import f

from swgsim.joint.effects.friction import QuadraticFriction, StribeckFriction, SublinearFriction
from swgsim.joint.recording import OF_DRIVE, JointRecording
from swgsim.joint.regression import Fit, Table, solved
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction, Zero

# Terms of friction that depend on speed only.
OF_SPEED = (Friction, SublinearFriction, QuadraticFriction, StribeckFriction)
# A session with a nearly constant friction curve does not show the slope over speed; relative limit.
FLAT = 0.1
# Least number of runs of a session, for the scatter between runs.
LEAST_RUNS = 3


@dataclass(frozen=True)
class Day:
    """Speed-dependent friction of one session, as a share of that of all sessions.

    All sessions share one friction curve, so that sessions at different speeds can be compared.

    Attributes
    ----------
    session : str
    share : float
        1 if the session has the common friction.
    deviation : float
        Its standard deviation.
    coulomb, zero : float
        Constant friction, and zero of the signal, in the unit of the signal. They cannot be separated for a joint that
        turned in one direction only.
    runs : int
        Number of runs behind the deviation.
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
        p-value of the differences.
    """

    days: tuple[Day, ...]
    chance: float

    @property
    def spread(self) -> float:
        """Largest minus smallest share."""
        shares = [day.share for day in self.days]
        return max(shares) - min(shares)


def days(top: Fit, tables: Sequence[Table]) -> Days | None:
    """Speed-dependent friction of every session in the current; None for fewer than two sessions.

    A session needs three runs, because their scatter gives the deviation.

    Parameters
    ----------
    top : Fit
        The model.
    tables : sequence of Table
        Fitted and held-out recordings.
    """
    if top.table.of not in OF_DRIVE:
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
    """Share of one session, with free constant friction and zero; None if the session does not determine it."""
    if len(table.recordings) < LEAST_RUNS:
        return None
    curve = np.concatenate([rising(each, terms) for each in table.recordings])
    (friction,) = (term for term in terms if isinstance(term, Friction))
    sense = np.concatenate([friction.sense(each) for each in table.recordings])
    others = [term for term in terms if not isinstance(term, (*OF_SPEED, Zero))]
    left = table.signal - sum(table.columns(term) @ np.array(term.weights) for term in others)
    open_ = np.stack([sense, np.ones(len(sense))], axis=1)
    free = curve - open_ @ solved(open_, curve)
    if free @ free <= FLAT**2 * (curve @ curve):
        return None
    share = float(free @ left / (free @ free))
    constant = solved(open_, left - share * curve)
    residual = left - share * curve - open_ @ constant
    # Residuals are correlated within a run.
    runs = len(table.recordings)
    spread = np.sqrt((np.bincount(table.run, free * residual) ** 2).sum() * runs / (runs - 1)) / float(free @ free)
    coulomb, zero = constant.tolist()
    return Day(session, share, float(spread), coulomb, zero, runs)


def rising(recording: JointRecording, terms: Sequence[Term]) -> np.ndarray:
    """Speed-dependent friction in the common model."""
    found = np.zeros(len(recording))
    for term in terms:
        if isinstance(term, Friction):
            # The first column is Coulomb friction, which does not depend on speed.
            term = replace(term, weights=(0.0, *term.weights[1:]))
        if isinstance(term, OF_SPEED):
            found += term.signal(recording)
    return found
