"""A ladder before recordings that it was not fitted to."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from swgsim.joint.ladder import Ladder, Trial
from swgsim.joint.regression import Fit, Table, rms
from swgsim.joint.slow import slow


@dataclass(frozen=True, eq=False)
class Rung:
    """One model on the way up, or one that was tried and refused.

    Attributes
    ----------
    trial : Trial or None
        What was added; None for the textbook model.
    fit, heldout : float
        Errors, in the unit of the signal.
    heldout_slow : float
        The latter below SLOW.
    kept : bool
    """

    trial: Trial | None
    fit: float
    heldout: float
    heldout_slow: float
    kept: bool


@dataclass(frozen=True, eq=False)
class Judged:
    """A ladder, and how its models do elsewhere.

    Attributes
    ----------
    ladder : Ladder
    heldout : Table
        Recordings that nothing was fitted to and nothing was chosen by.
    floor : float or None
        Noise of the signal at rest, in its unit, if recorded.
    """

    ladder: Ladder
    heldout: Table
    floor: float | None

    @property
    def table(self) -> Table:
        """What was fitted."""
        return self.ladder.top.table

    @cached_property
    def rungs(self) -> tuple[Rung, ...]:
        """The textbook model, every term that was kept, and those that were refused, each beside the top."""
        steps = (self._rung(step, step.fit, True) for step in self.ladder.steps)
        refused = (self._rung(trial, trial.fit, False) for trial in self.ladder.refused)
        return (self._rung(None, self.ladder.textbook, True), *steps, *refused)

    @cached_property
    def before(self) -> Rung:
        """The textbook model."""
        return self.rungs[0]

    @cached_property
    def after(self) -> Rung:
        """The model with all that was kept."""
        return self.rungs[len(self.ladder.steps)]

    def _rung(self, trial: Trial | None, fit: Fit, kept: bool) -> Rung:
        missed = fit.missed(self.heldout)
        return Rung(trial, fit.error, rms(missed), rms(slow(self.heldout, missed)), kept)


def noise_floor(at_rest: Table) -> float:
    """Standard deviation of a signal of joints that stand still."""
    parts = [each.signals[at_rest.of] - each.signals[at_rest.of].mean() for each in at_rest.recordings]
    return rms(np.concatenate(parts))


def standing_noise(standing: Table) -> float | None:
    """Root of the mean square above SLOW of a signal of a joint that stands while others move, in the quietest
    recording; None if all are too coarse to tell.

    Below, the load that the others put on it changes, and friction holds as much of it as it likes; above, they shake
    it.
    """
    fast = standing.signal - slow(standing, standing.signal)
    found = (rms(fast[standing.run == number]) for number in range(len(standing.recordings)))
    return min((each for each in found if each > 0), default=None)
