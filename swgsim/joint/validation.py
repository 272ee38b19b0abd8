"""Errors of the models of a ladder on held-out recordings."""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.stats import t

from swgsim.joint.ladder import Ladder, Trial
from swgsim.joint.regression import Fit, Table, rms, slow


@dataclass(frozen=True, eq=False)
class Rung:
    """One accepted or refused model.

    Attributes
    ----------
    trial : Trial or None
        The added term; None for the textbook model.
    fit, heldout : float
        Errors, in the unit of the signal.
    heldout_slow : float
        Error on held-out recordings below the frequency SLOW.
    kept : bool
    """

    trial: Trial | None
    fit: float
    heldout: float
    heldout_slow: float
    kept: bool


class Share(NamedTuple):
    """A share with half of its 95 % interval, for errors that are independent between stretches."""

    value: float
    half: float


@dataclass(frozen=True, eq=False)
class Validation:
    """A ladder with held-out recordings.

    Attributes
    ----------
    ladder : Ladder
    heldout : Table
        Recordings that neither the fit nor the selection used.
    floor : float or None
        Noise of the signal at rest, in its unit, if known.
    """

    ladder: Ladder
    heldout: Table
    floor: float | None

    @property
    def table(self) -> Table:
        """Fitted recordings, all rows alike."""
        return replace(self.ladder.top.table, trust=None)

    @cached_property
    def rungs(self) -> tuple[Rung, ...]:
        """The textbook model, every accepted term, and every refused term added to the last model."""
        steps = (self._rung(step, step.fit, True) for step in self.ladder.steps)
        refused = (self._rung(trial, trial.fit, False) for trial in self.ladder.refused)
        return (self._rung(None, self.ladder.textbook, True), *steps, *refused)

    @property
    def helps(self) -> bool:
        """Whether the accepted terms lower the error on the held-out recordings."""
        return self.after.heldout < self.before.heldout

    @property
    def steps(self) -> tuple[tuple[Rung, Rung], ...]:
        """Every accepted model with the one before it."""
        kept = self.rungs[: len(self.ladder.steps) + 1]
        return tuple(pairwise(kept))

    @property
    def contradicted(self) -> tuple[Trial, ...]:
        """Accepted effects that raise the error on the held-out recordings."""
        return tuple(now.trial for last, now in self.steps if now.trial and now.heldout > last.heldout)

    @property
    def confirmed(self) -> tuple[Trial, ...]:
        """Accepted effects that do not."""
        return tuple(now.trial for last, now in self.steps if now.trial and now.heldout <= last.heldout)

    @property
    def scatter(self) -> float:
        """Standard deviation of the signal of the held-out recordings, which is the error of a constant."""
        return float(np.std(self.heldout.signal))

    def explained(self, fit: Fit, *, slowly: bool = False) -> Share:
        """Share of the variance of the held-out signal that a model explains.

        Parameters
        ----------
        fit : Fit
        slowly : bool
            Whether errors above the frequency SLOW are ignored: ripples and noise, which the textbook does not have.
        """
        missed = fit.missed(self.heldout)
        errors, variance = (slow(self.heldout, missed) if slowly else missed) ** 2, self.scatter**2
        share = 1 - float(errors.mean()) / variance if variance else 0.0
        # Of a ratio of two sums over stretches, to the first order.
        signal = self.heldout.signal
        off = errors - (1 - share) * (signal - signal.mean()) ** 2
        sums = np.bincount(self.heldout.stretch, off)
        number = max(len(sums), 2)
        deviation = float(np.sqrt(number / (number - 1) * (sums**2).sum())) / (len(signal) * variance or 1.0)
        return Share(share, float(t.ppf(0.975, number - 1)) * deviation)

    @cached_property
    def before(self) -> Rung:
        """The textbook model."""
        return self.rungs[0]

    @cached_property
    def after(self) -> Rung:
        """The model with all accepted terms."""
        return self.rungs[len(self.ladder.steps)]

    def _rung(self, trial: Trial | None, fit: Fit, kept: bool) -> Rung:
        missed = fit.missed(self.heldout)
        return Rung(trial, fit.error, rms(missed), rms(slow(self.heldout, missed)), kept)


def noise_floor(at_rest: Table) -> float:
    """Standard deviation of a signal of joints at standstill."""
    parts = [each.signals[at_rest.of] - each.signals[at_rest.of].mean() for each in at_rest.recordings]
    return rms(np.concatenate(parts))


def standing_noise(standing: Table) -> float | None:
    """Root mean square above the frequency SLOW of a signal of a joint that stands while others move, in the quietest
    recording; None if all are quantised too coarsely.

    Below SLOW, the load from the other joints changes, and static friction carries an unknown part of it.
    """
    fast = standing.signal - slow(standing, standing.signal)
    found = (rms(fast[standing.run == number]) for number in range(len(standing.recordings)))
    return min((each for each in found if each > 0), default=None)
