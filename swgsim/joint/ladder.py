"""The ladder: forward selection of effects by cross-validated error, from the textbook model upwards."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import ttest_1samp
from tqdm import tqdm

from swgsim.joint.naming import in_words
from swgsim.joint.recording import SIGNALS
from swgsim.joint.regression import LEAST_GAIN, Fit, Table, fit, rms
from swgsim.joint.row_variance import weighted_by_variance
from swgsim.joint.shaping import shaped
from swgsim.joint.shared import OfFriction, OfLoad
from swgsim.joint.sign_width import with_sign_width
from swgsim.joint.term import Term
from swgsim.joint.textbook import fitted_textbook, with_link
from swgsim.joint.waves import LOOKED_AT, Wave, waves

# Significance level of an effect or wave in one round, and of an order that stands out of the spectrum.
ALPHA, LINE_ALPHA = 0.05, 0.005
# Largest number of added effects.
MOST_STEPS = 24


@dataclass(frozen=True, eq=False)
class Trial:
    """A candidate: one term added to a fit.

    Attributes
    ----------
    term : Term
        With weights.
    fit : Fit
        Fit with this term.
    gain : float
        Relative reduction of the cross-validated error.
    worst : float
        The same for the session with the least gain; negative if its error rises.
    chance : float
        p-value of the gain over stretches of the recordings, times the number of candidates.
    """

    term: Term
    fit: Fit
    gain: float
    worst: float
    chance: float

    @property
    def accepted(self) -> bool:
        """Whether the gain is large enough, significant, and larger than the loss of any session."""
        return self._helps and self.chance < ALPHA

    @property
    def unsteady(self) -> bool:
        """Whether only the significance is missing, so that more recordings might decide."""
        return self._helps and self.chance >= ALPHA

    @property
    def _helps(self) -> bool:
        return not self._unphysical and self.gain > LEAST_GAIN and self.worst > -self.gain

    @property
    def _unphysical(self) -> Term | None:
        """First term with a sign that its physics forbids; the new term is checked first."""
        return next((term for term in reversed(self.fit.terms) if not term.has_physical_sign), None)

    @property
    def why(self) -> str:
        """Reason of the refusal, in words."""
        if self._unphysical:
            own = self._unphysical is self.fit.terms[-1]
            return (
                "its size would have the wrong sign" if own else f"{self._unphysical.title()} would have the wrong sign"
            )
        if self.gain <= 0:
            return f"raises the cross-validated error by {-100 * self.gain:.2g} %"
        if self.gain <= LEAST_GAIN:
            return f"lowers the cross-validated error by only {100 * self.gain:.2g} %"
        if self.worst <= -self.gain:
            return f"lowers the error by {100 * self.gain:.2g} %, raises that of a session by {-100 * self.worst:.2g} %"
        if self.chance >= ALPHA:
            return f"its gain of {100 * self.gain:.2g} % is not significant: p-value {self.chance:.1g}"
        return ""


@dataclass(frozen=True, eq=False)
class Ladder:
    """Result of the forward selection.

    Attributes
    ----------
    textbook : Fit
    steps : tuple of Trial
        Accepted terms, in order.
    refused : tuple of Trial
        Candidates of the last round.
    unsearched : tuple of Term
        Effects of the library whose load is not known.
    """

    textbook: Fit
    steps: tuple[Trial, ...]
    refused: tuple[Trial, ...]
    unsearched: tuple[Term, ...] = ()

    @property
    def top(self) -> Fit:
        """The model with all accepted terms."""
        return self.steps[-1].fit if self.steps else self.textbook


def forward_selection(
    table: Table, kinds: Sequence[type[Term]], progress: Callable[[str], None] = lambda _: None, *, bar: bool = False
) -> Ladder:
    """Add the best candidate, round after round, as long as one is accepted.

    Parameters
    ----------
    table : Table
        Recordings to fit, without held-out ones.
    kinds : sequence of classes of terms
        The library.
    progress : callable
        Receives one line of text for each step.
    bar : bool
        Whether to show a progress bar of the candidates.
    """
    now = start = with_link(weighted_by_variance(fitted_textbook(table)))
    unit, ratio = SIGNALS[table.of].unit, table.recordings[0].gear_ratio
    progress(f"textbook model: error {now.error:.4g} {unit} on the {len(table.recordings)} fitted recordings")
    steps: list[Trial] = []
    known: dict[float, tuple[Wave, ...]] = {}
    library = [kind().added_to(start.terms) for kind in kinds]
    possible = [term for term in library if _possible(term, start)]
    # Errors of a rigid-body model have no meaning without it.
    open_ = [term for term in library if isinstance(term, OfLoad) and table.of in term.explains and not term.of_model]
    unsearched = tuple(term for term in open_ if not all(map(term.possible, table.recordings)))
    while True:
        sought = [term.added_to(now.terms) for term in possible if type(term) not in {type(each) for each in now.terms}]
        candidates = _candidates(now, sought, known)
        tested = tqdm(
            candidates, f"step {len(steps) + 1}", unit=" candidates", leave=False, disable=None if bar else True
        )
        trials = sorted(tested, key=lambda trial: -trial.gain)
        best = next((trial for trial in trials if trial.accepted), None)
        if best is None or len(steps) == MOST_STEPS:
            progress(f"step {len(steps) + 1}: none of {len(trials)} candidates is accepted")
            return Ladder(start, tuple(steps), tuple(trials), unsearched)
        now = with_sign_width(best.fit)
        steps.append(replace(best, term=now.terms[-1], fit=now))
        what = in_words(best.term, ratio)
        progress(f"step {len(steps)}: + {what}: error {now.error:.4g} {unit} on the fitted recordings")


def _possible(term: Term, textbook: Fit) -> bool:
    """Whether an effect may explain the signal, beside the textbook model."""
    table = textbook.table
    brakes = not isinstance(term, OfFriction) or any(isinstance(each, OfFriction) for each in textbook.terms)
    measured = any(getattr(each, "measured", False) for each in textbook.terms)
    return (
        table.of in term.explains
        and brakes
        and not (term.of_model and measured)
        and all(map(term.possible, table.recordings))
    )


def _candidates(now: Fit, sought: Sequence[Term], known: dict[float, tuple[Wave, ...]]) -> Iterator[Trial]:
    """Effects of the library with their best inner parameters, and waves."""
    for term in sought:
        yield _tried(now, shaped(now, term), len(sought))
    for shapes in waves(now, LINE_ALPHA, known):
        yield _best(now, shapes)


def _best(now: Fit, shapes: Sequence[Wave]) -> Trial:
    """The shape of a wave with the largest gain, accepted shapes first."""
    # The correction counts all orders that were looked at, in as many shapes.
    trials = [_tried(now, shape, LOOKED_AT * len(shapes)) for shape in shapes]
    return max(trials, key=lambda trial: (trial.accepted, trial.gain))


def _tried(now: Fit, term: Term, trials: int) -> Trial:
    """Add a term to a fit."""
    added = fit(now.table, (*now.terms, term))
    before, after = now.unseen, added.unseen
    session = now.table.session
    worst = 1 - float(np.sqrt((np.bincount(session, after**2) / np.bincount(session, before**2)).max()))
    chance = _p_value(now, added, relative=isinstance(term, Wave))
    return Trial(added.terms[-1], added, 1 - rms(after) / rms(before), worst, min(1.0, chance * trials))


def _p_value(now: Fit, added: Fit, *, relative: bool) -> float:
    """p-value of the reduction of the error over the stretches of the recordings.

    A wave acts everywhere, so its ``relative`` reduction in each stretch counts. Other effects may act in few
    stretches, such as friction at standstill, so their mean square counts. The zero of a signal may differ from run to
    run, which is no evidence for an effect: each run has its own zero here. A run in one direction shows friction and
    zero as one number, so it counts once for effects that are no waves, by its relative reduction: runs are few.
    """
    once = not relative and not any(each.reverses for each in now.table.recordings)
    table = now.table
    unit = table.run if once else table.stretch
    before, after = (each.unseen if once else each.unseen_but_zeros for each in (now, added))
    rows = np.bincount(unit)
    whole = rows > np.median(rows) / 2  # stretches at the end of a recording may be short
    if whole.sum() < 3:
        return 1.0
    squares = [np.bincount(unit, residual**2)[whole] / rows[whole] for residual in (before, after)]
    roots = np.sqrt(squares)
    everywhere = relative or once
    saved = (roots[0] - roots[1]) / np.maximum(roots.sum(axis=0), 1e-300) if everywhere else squares[0] - squares[1]
    return float(ttest_1samp(saved, 0, alternative="greater").pvalue)
