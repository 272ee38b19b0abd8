"""The ladder: from the textbook model upwards, the effect that helps most on unseen recordings, as long as one does."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import ttest_1samp

from swgsim.joint.regression import Fit, Table, fit, rms
from swgsim.joint.shaping import shaped
from swgsim.joint.term import Term
from swgsim.joint.textbook import textbook
from swgsim.joint.waves import LOOKED_AT, Wave, waves

# Probability of a false effect of the library, and of a false wave, in a round of trials, beside the other demands; and
# of a false order among all.
ALPHA, LINE_ALPHA = 0.05, 0.005
# Share by which the error on unseen groups must fall; less is not worth a term.
LEAST = 0.005
# Effects that are added at most.
MOST = 24


@dataclass(frozen=True, eq=False)
class Trial:
    """A term beside the others of a fit.

    Attributes
    ----------
    term : Term
        With weights.
    fit : Fit
        With it.
    gain : float
        Share by which it lowers the error on groups that were left out.
    worst : float
        That of the session which it helps least; negative where it harms.
    chance : float
        Probability of so steady a gain by luck, over stretches of the recordings, times the terms tried beside it.
    """

    term: Term
    fit: Fit
    gain: float
    worst: float
    chance: float

    @property
    def pays(self) -> bool:
        """Whether it helps where it was not fitted: enough, by more than luck, and harms no session more than that."""
        return self._helps and self.chance < ALPHA

    @property
    def unsteady(self) -> bool:
        """Whether it would help but for luck, so that more recordings might decide about it."""
        return self._helps and self.chance >= ALPHA

    @property
    def _helps(self) -> bool:
        return not self._unsound and self.gain > LEAST and self.worst > -self.gain

    @property
    def _unsound(self) -> Term | None:
        """The first term that would have a sign that its physics forbids; the new one comes first."""
        return next((term for term in reversed(self.fit.terms) if not term.sound), None)

    @property
    def why(self) -> str:
        """Why it was not kept, in words."""
        if self._unsound:
            own = self._unsound is self.fit.terms[-1]
            return "its size would have the wrong sign" if own else f"{self._unsound.title()} would have the wrong sign"
        if self.gain <= 0:
            return f"raises the error on groups left out by {-100 * self.gain:.2g} %"
        if self.gain <= LEAST:
            return f"lowers the error on groups left out by {100 * self.gain:.2g} % only"
        if self.worst <= -self.gain:
            return f"lowers the error by {100 * self.gain:.2g} %, raises that of a session by {-100 * self.worst:.2g} %"
        if self.chance >= ALPHA:
            return f"its gain of {100 * self.gain:.2g} % is not steady: chance {self.chance:.1g} by luck"
        return ""


@dataclass(frozen=True, eq=False)
class Ladder:
    """What climbing found.

    Attributes
    ----------
    textbook : Fit
    steps : tuple of Trial
        The terms that were kept, in order.
    refused : tuple of Trial
        Of every other kind, and of orders that stand out, the last trial.
    """

    textbook: Fit
    steps: tuple[Trial, ...]
    refused: tuple[Trial, ...]

    @property
    def top(self) -> Fit:
        """The model with all that was kept."""
        return self.steps[-1].fit if self.steps else self.textbook


def climb(table: Table, kinds: Sequence[type[Term]], tell: Callable[[str], None] = lambda _: None) -> Ladder:
    """Add the term that helps most, again and again.

    Parameters
    ----------
    table : Table
        Recordings to fit; those that judge must not be among them.
    kinds : sequence of classes of terms
        The library.
    tell : callable
        Is told of every step.
    """
    now = start = fit(table, textbook(table.recordings, table.of))
    steps: list[Trial] = []
    known: dict[float, tuple[Wave, ...]] = {}
    possible = [k for k in kinds if table.of in k.explains and all(map(k.possible, table.recordings))]
    while True:
        sought = [kind for kind in possible if kind not in {type(term) for term in now.terms}]
        effects = [_tried(now, shaped(now, kind()), len(sought)) for kind in sought]
        found = [_best(now, shapes) for shapes in waves(now, LINE_ALPHA, known)]
        trials = sorted((*effects, *found), key=lambda trial: -trial.gain)
        best = next((trial for trial in trials if trial.pays), None)
        if best is None or len(steps) == MOST:
            return Ladder(start, tuple(steps), tuple(trials))
        steps.append(best)
        now = best.fit
        tell(f"{best.term.title()}: {now.error:.4g}")


def _best(now: Fit, shapes: Sequence[Wave]) -> Trial:
    """The shape of a wave that helps most, of those that pay if any does."""
    # Every order was tried that could have been it, in as many shapes.
    trials = [_tried(now, shape, LOOKED_AT * len(shapes)) for shape in shapes]
    return max(trials, key=lambda trial: (trial.pays, trial.gain))


def _tried(now: Fit, term: Term, trials: int) -> Trial:
    """A term added to a fit."""
    added = fit(now.table, (*now.terms, term))
    before, after = now.unseen, added.unseen
    session = now.table.session
    worst = 1 - float(np.sqrt((np.bincount(session, after**2) / np.bincount(session, before**2)).max()))
    chance = _luck(now.table, before, after, always=isinstance(term, Wave))
    return Trial(added.terms[-1], added, 1 - rms(after) / rms(before), worst, min(1.0, chance * trials))


def _luck(table: Table, before: Float[np.ndarray, " row"], after: Float[np.ndarray, " row"], *, always: bool) -> float:
    """Probability that luck saves as much over the stretches of the recordings.

    A wave acts ``always``: it must save a share of the error of most stretches, however large that is. Another effect
    may act in few, such as friction while a joint stands: there the mean square counts.
    """
    rows = np.bincount(table.stretch)
    whole = rows > np.median(rows) / 2  # stretches at the end of a recording may be short
    if whole.sum() < 3:
        return 1.0
    squares = [np.bincount(table.stretch, residual**2)[whole] / rows[whole] for residual in (before, after)]
    roots = np.sqrt(squares)
    saved = (roots[0] - roots[1]) / np.maximum(roots.sum(axis=0), 1e-300) if always else squares[0] - squares[1]
    return float(ttest_1samp(saved, 0, alternative="greater").pvalue)
