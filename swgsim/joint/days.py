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
# Least number of runs whose scatter gives a deviation.
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
    deviation : float or None
        Its standard deviation, from the scatter between runs; None for fewer than three runs.
    coulomb, zero : float
        Constant friction, and zero of the signal, in the unit of the signal. They cannot be separated for a joint that
        turned in one direction only.
    runs : int
        Number of runs.
    """

    session: str
    share: float
    deviation: float | None
    coulomb: float
    zero: float
    runs: int


@dataclass(frozen=True)
class Days:
    """All sessions.

    Attributes
    ----------
    days : tuple of Day
    chance : float or None
        p-value of the differences; None for fewer than two sessions with a deviation.
    """

    days: tuple[Day, ...]
    chance: float | None

    @property
    def spread(self) -> float:
        """Largest minus smallest share."""
        shares = [day.share for day in self.days]
        return max(shares) - min(shares)


def days(top: Fit, tables: Sequence[Table]) -> Days | None:
    """Speed-dependent friction of every session in the current; None for fewer than two sessions that show it.

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
    return Days(known, _chance([(day.share, day.deviation, day.runs) for day in known if day.deviation is not None]))


def no_days(tables: Sequence[Table]) -> str:
    """Why no friction of sessions is given, in words."""
    if tables[0].of not in OF_DRIVE:
        return "a torque sensor behind the gear does not measure its friction"
    sessions = {each.session for table in tables for each in table.recordings}
    if len(sessions) < 2:
        return f"all recordings are of one session ({sessions.pop()}): give others another session in the source"
    return "fewer than two sessions move at several speeds, which the slope of the friction over speed needs"


def _chance(known: Sequence[tuple[float, float, int]]) -> float | None:
    """p-value of the differences of shares with their deviations and numbers of runs."""
    if len(known) < 2:
        return None
    share, deviation, runs = np.array(known).T
    weight = deviation**-2.0
    mean = (weight * share).sum() / weight.sum()
    freedom = len(known) - 1, runs.min() - 2
    return float(f.sf((weight * (share - mean) ** 2).sum() / freedom[0], *freedom))


def _day(session: str, table: Table, terms: Sequence[Term]) -> Day | None:
    """Share of one session, with free constant friction and zero; None if the session does not determine it."""
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
    coulomb, zero = constant.tolist()
    runs = len(table.recordings)
    if runs < LEAST_RUNS:
        return Day(session, share, None, coulomb, zero, runs)
    # Residuals are correlated within a run.
    spread = np.sqrt((np.bincount(table.run, free * residual) ** 2).sum() * runs / (runs - 1)) / float(free @ free)
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
