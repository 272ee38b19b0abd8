"""The answer of an identification: the fitted models, the effects found, and the unexplained remainder."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass

from swgsim.chain.steady_state_cache import forget
from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.effects.base import Effect
from swgsim.effects.line_between import LineBetween
from swgsim.effects.regularity import Regularity
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.candidate import Trial
from swgsim.identification.decide.empirical_terms import patched
from swgsim.identification.decide.selection import Closed
from swgsim.identification.decide.stepwise_selection import close
from swgsim.identification.fit.unit import Unit
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_search import all_cleaned, search
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.search.high_orders import above
from swgsim.identification.search.regularities import Described
from swgsim.identification.search.screening import Score
from swgsim.identification.search.shortlist import ALPHA
from swgsim.recordings.recording import Recording

# Largest number of regularities that are described at high orders.
MOST_ABOVE = 3
# The nearest known effect is reported if it explains at least this share of the remainder.
LEAST_EXPLAINED = 0.1
STEPS = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Answer:
    """The answer of an identification.

    Attributes
    ----------
    verdict : str
        NOTHING, FOUND or UNKNOWN.
    closed : Closed
    known : tuple of Effect
        Declared effects that make interharmonic lines; they are not part of the model of the order lines.
    lines : tuple of Sideline
        Found effects that make interharmonic lines.
    unnamed : tuple of Unnamed
        Interharmonic lines without a known cause.
    above : tuple of Described
        Regularities at orders above those of the model.
    absorbed : tuple of Score
        Effects that these recordings cannot test: nuisance parameters absorb their signatures.
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
        """Effects and regularities that were added to the model of the order lines."""
        return self.closed.after.added

    @property
    def patches(self) -> tuple[Regularity, ...]:
        """Regularities that were added to the model; they name no cause."""
        return tuple(effect for effect in self.added if isinstance(effect, Regularity))

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The physical effects that were found."""
        chain = (effect for effect in self.added if not isinstance(effect, Regularity))
        return (*chain, *(line.effect for line in self.lines))

    @property
    def bare_lines(self) -> tuple[LineBetween, ...]:
        """The interharmonic lines without a known cause, as effects that can be declared."""
        return tuple(part.effect for line in self.unnamed for part in line.parts)

    @property
    def unexplained(self) -> str:
        """The unexplained remainder in words; empty if there is no remainder."""
        described = "; ".join(map(str, (*self.unknown, *self.unnamed)))
        return described or ("a regularity without a simple description" if self.closed.rejected else "")

    @property
    def nearest(self) -> Trial | None:
        """The known effect that explains most of an unknown remainder and was not accepted, or None."""
        return self.closed.nearest if self.closed.nearest_explains >= LEAST_EXPLAINED else None


def answer(
    recordings: Sequence[Recording],
    unit: Unit,
    kinds: Sequence[type[Effect]],
    *,
    known: Sequence[Effect] = (),
    seed: int = 0,
) -> Answer:
    """Find what the model of a unit lacks.

    Parameters
    ----------
    recordings : sequence of Recording
    unit : Unit
        The unit before these recordings.
    kinds : sequence of effect classes
        The library.
    known : sequence of Effect
        Declared effects that make interharmonic lines.
    seed : int
    """
    forget()
    STEPS.info("searching interharmonic lines in %d recordings", len(recordings))
    N = unit.model.gear.transmission.N
    lines = search(gauge_spectra(recordings, N), kinds, ALPHA, known, gauge_spectra(unit.healthy, N))
    clean = all_cleaned(recordings, lines.effects, N)
    closed = close(Measured.of(clean), unit, kinds, seed=seed)
    STEPS.info("describing the remainder")
    high = above(clean, unit.healthy, closed.before.model, closed.after.model, ALPHA, MOST_ABOVE)
    found, unknown = closed.steps or lines.named, closed.rejected or closed.unknown or lines.unnamed or high
    verdict = FOUND if found else UNKNOWN if unknown else NOTHING
    return Answer(verdict, patched(closed), tuple(known), lines.named, lines.unnamed, high, untestable(closed))


def untestable(closed: Closed) -> tuple[Score, ...]:
    """Effects that the recordings cannot test, without those that were found by a deviation from their library form."""
    tested = {type(e) for step in closed.steps for trial in (step.accepted, *step.rivals) for e in trial.effects}
    return tuple(score for score in closed.scores if score.absorbed and score.hypothesis.kind not in tested)
