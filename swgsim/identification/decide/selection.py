"""What closing the loop found."""

from dataclasses import dataclass, replace
from functools import cached_property, reduce

import numpy as np

from swgsim.identification.decide.accepted import Step
from swgsim.identification.decide.candidate import Trial, widened
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import Coherence, coherence, doubt_by_others
from swgsim.identification.search.regularities import Described, set_free
from swgsim.identification.search.screening import Score


@dataclass(frozen=True, eq=False)
class Closed:
    """What closing the loop found.

    Attributes
    ----------
    before, after : Fitted
        The model without and with what was found; all effects were fitted together, if that came to rest.
    asked : Fitted
        The model of the last asking, with the form of what was found open within the tolerance: of what this leaves it
        is asked what more is missing.
    steps : tuple of Step
    scores : tuple of Score
        Of the first screening, best hypothesis of each effect.
    left : tuple of Score
        Of the last screening.
    rejected : tuple of Trial
        Significant, but of the wrong form: they contradict themselves, cancel one another, a bare regularity explains
        more, they may be part of one that was set apart, or bring too little beside what they leave.
    outdone_by : Described or None
        That regularity.
    apart : tuple of Described
        Disturbances of single channels that were set apart before an effect was found behind them.
    withdrawn : tuple of Trial
        Accepted at first, and another one, or nothing, in its place once the others were in the model.
    cancelling : tuple of Trial
        Accepted, until they were seen to cancel one another; they are among the rejected.
    outweighed : tuple of Trial
        Accepted, until they were seen to leave more than a tenth of what they brought; they are among the rejected.
    unknown : tuple of Described
        What no effect of the library explains: what was set apart first.
    """

    before: Fitted
    after: Fitted
    asked: Fitted
    steps: tuple[Step, ...]
    scores: tuple[Score, ...]
    left: tuple[Score, ...]
    rejected: tuple[Trial, ...]
    outdone_by: Described | None
    apart: tuple[Described, ...] = ()
    withdrawn: tuple[Trial, ...] = ()
    cancelling: tuple[Trial, ...] = ()
    outweighed: tuple[Trial, ...] = ()
    unknown: tuple[Described, ...] = ()

    @property
    def best_rejected(self) -> Trial | None:
        """Of what was rejected: the trial that was judged."""
        return self.rejected[0] if self.rejected and self.rejected[0].there else None

    @cached_property
    def nearest(self) -> Trial | None:
        """Of what was rejected: the trial that explains most of what is left in the library's own form.

        Another one may predict it better, its form being open.
        """
        fitted = (trial for trial in self.rejected if trial.there)
        return max(fitted, key=lambda trial: trial.explained(self.asked), default=None)

    @cached_property
    def nearest_explains(self) -> float:
        """Share of what is left in the order lines by which :attr:`nearest` makes their sum of squares fall.

        Beyond that of noise, but no less is left than it explains, or than the regularities do that were described.
        """
        if self.nearest is None:
            return 0.0
        left, explained = self.asked.whole.whiten(self.asked.from_start), self.nearest.explained(self.asked)
        described = sum(each.gain for each in self.unknown if each not in self.apart)
        return explained / max(float(left @ left) - len(left), explained, described)

    @cached_property
    def coherence(self) -> tuple[Coherence, ...]:
        """How well the parts of each effect agree once all that was found is in the model.

        When one was accepted, those that were found later still passed for an imperfect form of it. An imperfect form
        of one leaves the sizes of the others in doubt too.
        """
        first, after = len(self.before.model.effects), self._beside_what_is_apart
        beside = [step.accepted.beside for step in self.steps for _ in step.accepted.effects]
        found = {n: coherence(reduce(set_free, each, after), n) for n, each in enumerate(beside, first)}
        by_others = (doubt_by_others(after, n, {m: c for m, c in found.items() if m != n}) for n in found)
        return tuple(
            replace(each, doubt=float(np.hypot(each.doubt, more)))
            for each, more in zip(found.values(), by_others, strict=True)
        )

    @cached_property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, by noise, all shapes and the imperfect form of all effects."""
        return widened(self._beside_what_is_apart, len(self.before.model.effects), self.coherence)

    @property
    def _beside_what_is_apart(self) -> Fitted:
        """The model with what was found, what was set apart being free as when that was fitted."""
        return reduce(set_free, self.apart, self.after)
