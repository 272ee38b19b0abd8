"""The answer of the loop: what is missing in the model, in one sentence and in numbers."""

from collections.abc import Sequence
from dataclasses import dataclass

from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.effects.base import Effect
from swgsim.effects.line_between import LineBetween
from swgsim.effects.regularity import Regularity
from swgsim.effects.text import in_words
from swgsim.identification.search.high_orders import above
from swgsim.identification.interharmonics.interharmonic_spectrum import between
from swgsim.identification.decide.selection import Closed
from swgsim.identification.decide.stepwise_selection import close
from swgsim.identification.search.shortlist import ALPHA
from swgsim.identification.interharmonics.line_search import cleaned, search
from swgsim.identification.decide.empirical_terms import patched
from swgsim.identification.search.screening import Score
from swgsim.identification.data.measured import Measured
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.fit.unit import Unit
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.search.regularities import Described
from swgsim.recordings.recording import Recording
from swgsim.chain.steady_state_cache import forget

# Regularities at high orders that are described at most.
MOST_ABOVE = 3
# A known effect that explains less of what is left is not near it.
LEAST_EXPLAINED = 0.1
# Effects that cannot be decided, named in the sentence at most; the report has them all.
MOST_NAMED = 6


@dataclass(frozen=True, eq=False)
class Answer:
    """What closing the loop says.

    Attributes
    ----------
    verdict : str
        NOTHING, FOUND or UNKNOWN.
    closed : Closed
    known : tuple of Effect
        Declared effects between the orders; the model of the order lines does without them.
    lines : tuple of Sideline
        Effects between the orders that were found.
    unnamed : tuple of Unnamed
        Lines between the orders that none explains.
    above : tuple of Described
        Regularities at orders above those that the model is compared at.
    absorbed : tuple of Score
        Effects that these recordings cannot tell from what the model declares not to know.
    """

    verdict: str
    closed: Closed
    known: tuple[Effect, ...]
    lines: tuple[Sideline, ...]
    unnamed: tuple[Unnamed, ...]
    above: tuple[Described, ...]
    absorbed: tuple[Score, ...]

    @property
    def unknown(self) -> tuple[Described, ...]:
        """Regularities that no effect of the library explains."""
        return (*self.closed.unknown, *self.above)

    @property
    def added(self) -> tuple[Effect, ...]:
        """What the model of the order lines has now and lacked before."""
        return self.closed.after.added

    @property
    def patches(self) -> tuple[Regularity, ...]:
        """Regularities without a cause among it."""
        return tuple(effect for effect in self.added if isinstance(effect, Regularity))

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The physical effects that were found."""
        chain = (effect for effect in self.added if not isinstance(effect, Regularity))
        return (*chain, *(line.effect for line in self.lines))

    @property
    def bare_lines(self) -> tuple[LineBetween, ...]:
        """The lines between the orders that none explains, as effects that a model can be given."""
        return tuple(part.effect for line in self.unnamed for part in line.parts)

    @property
    def unexplained(self) -> str:
        """What no known effect explains, in words; empty if there is nothing."""
        described = "; ".join(map(str, (*self.unknown, *self.unnamed)))
        return described or ("a regularity without a simple description" if self.closed.rejected else "")

    @property
    def nearest(self) -> Trial | None:
        """Where something unknown is left: the known effect that comes nearest and was not accepted; if one is near."""
        return self.closed.nearest if self.closed.nearest_explains >= LEAST_EXPLAINED else None

    @property
    def sentence(self) -> str:
        """The verdict in one sentence."""
        if self.verdict == NOTHING:
            return (
                f"Nothing is missing: the model explains the recordings down to their noise{self._if_balanced}, and no "
                f"effect of the library stands out of it{self._undecided}."
            )
        rest = f"; something unknown is left: {self.unexplained}{self._nearest}" if self.unexplained else ""
        if self.verdict == FOUND:
            return f"The model lacks {' and '.join(self._explanations())}{rest}."
        return f"The model lacks something that is not in the library: {self.unexplained}{self._nearest}."

    @property
    def _if_balanced(self) -> str:
        """The condition under which nothing is missing, where zeros had to lie further off than declared."""
        zeros = self.closed.after.measured.zeros
        if zeros == 1:
            return ""
        return (
            f", if bridges were balanced anew (zeros of gauges lie up to {zeros:g} times as far off as between two "
            "sessions; something that shifts them would look the same)"
        )

    @property
    def _undecided(self) -> str:
        """What nothing can be said of, as these recordings absorb it."""
        if not self.absorbed:
            return ""
        names = [score.hypothesis.kind.title() for score in self.absorbed]
        more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
        return f"; cannot be decided, as these recordings absorb them: {', '.join(names[:MOST_NAMED])}{more}"

    @property
    def _nearest(self) -> str:
        if self.nearest is None:
            return ""
        known, share = " with ".join(map(in_words, self.nearest.effects)), 100 * self.closed.nearest_explains
        return f"; the nearest known effect, {known}, explains {share:.0f} % of it and was not accepted"

    def _explanations(self) -> list[str]:
        """What was found, step by step, each with what these recordings cannot tell from it."""
        found, effects = [], iter(self.effects)
        for step in self.closed.steps:
            own = " and ".join(in_words(next(effects)) for _ in step.accepted.effects)
            rivals = " or ".join(" with ".join(map(in_words, rival.effects)) for rival in step.rivals)
            found.append(own + (f" (or {rivals}, which these recordings cannot tell from it)" if rivals else ""))
        return [*found, *map(in_words, effects)]


def answer(
    recordings: Sequence[Recording],
    unit: Unit,
    kinds: Sequence[type[Effect]],
    *,
    known: Sequence[Effect] = (),
    seed: int = 0,
) -> Answer:
    """Close the loop on recordings.

    Parameters
    ----------
    recordings : sequence of Recording
    unit : Unit
        What is known of the gear before.
    kinds : sequence of effect classes
        The library.
    known : sequence of Effect
        Declared effects between the orders.
    seed : int
    """
    forget()
    N = unit.model.gear.transmission.N
    lines = search(between(recordings, N), kinds, ALPHA, known)
    clean = [cleaned(recording, lines.effects, N) for recording in recordings] if lines.effects else recordings
    closed = close(Measured.of(clean), unit, kinds, seed=seed)
    high = above(clean, unit.healthy, closed.before.model, closed.after.model, ALPHA, MOST_ABOVE)
    found, unknown = closed.steps or lines.named, closed.rejected or closed.unknown or lines.unnamed or high
    verdict = FOUND if found else UNKNOWN if unknown else NOTHING
    return Answer(verdict, patched(closed), tuple(known), lines.named, lines.unnamed, high, untestable(closed))


def untestable(closed: Closed) -> tuple[Score, ...]:
    """Effects that the recordings do not show; one that was found by its imperfect form they do show."""
    told = {type(e) for step in closed.steps for trial in (step.accepted, *step.rivals) for e in trial.effects}
    return tuple(score for score in closed.scores if score.absorbed and score.hypothesis.kind not in told)
