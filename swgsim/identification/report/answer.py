"""The answer of an identification: the fitted models, the effects found, and the unexplained remainder."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from swgsim.chain.steady_state_cache import forget
from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.effects.base import Effect
from swgsim.effects.line_between import LineBetween
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.decision import Decision, decide
from swgsim.identification.decide.option import Option
from swgsim.identification.fit.unit import Unit
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_search import all_cleaned, search
from swgsim.identification.interharmonics.named_interharmonics import Sideline
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.identification.report.interest import INTEREST, shares_of_spread
from swgsim.identification.search.high_orders import high_order_regularities
from swgsim.identification.search.regularities import Described
from swgsim.identification.search.screening import ALPHA, Score
from swgsim.recordings.recording import Recording

# Largest number of regularities that are described at high orders.
MOST_ABOVE = 3
STEPS = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Answer:
    """The answer of an identification.

    Attributes
    ----------
    decision : Decision
        Of the order lines: the options with their probabilities, and the model with the most probable one.
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
    interest : float
        Smallest change that matters (:data:`swgsim.identification.report.interest.INTEREST`).
    """

    decision: Decision
    known: tuple[Effect, ...]
    lines: tuple[Sideline, ...]
    unnamed: tuple[Unnamed, ...]
    above: tuple[Described, ...]
    absorbed: tuple[Score, ...]
    interest: float = INTEREST

    @property
    def verdict(self) -> str:
        """NOTHING, FOUND or UNKNOWN."""
        return FOUND if self.effects else UNKNOWN if self.unknown or self.unnamed else NOTHING

    @cached_property
    def shares_of_spread(self) -> list[float]:
        """Largest change of a line by each effect, then by each regularity (:func:`shares_of_spread`).

        Regularities that describe a cause which resembles effects are parts of it, and as large as these would be.
        """
        shares, named = shares_of_spread(self.decision.after), len(self.decision.effects)
        best, _ = self.decision.answers[0]
        if not best.resembled:
            return shares
        of_fit = zip(best.fitted.added, shares_of_spread(best.fitted), strict=True)
        cause = max(share for effect, share in of_fit if effect in best.resembled)
        return [*shares[:named], *(max(share, cause) for share in shares[named:])]

    @property
    def small(self) -> tuple[Effect, ...]:
        """Effects and regularities that are probable, but too small to matter."""
        return tuple(e for e, share in zip(self.added, self.shares_of_spread, strict=True) if share < self.interest)

    @property
    def unknown(self) -> tuple[Described, ...]:
        """Regularities that no effect of the library explains, without small ones."""
        return (*self.unknown_of_orders, *self.above)

    @property
    def unknown_of_orders(self) -> tuple[Described, ...]:
        """Those of the order lines of the model."""
        shares = self.shares_of_spread[len(self.decision.effects) :]
        regularities = zip(self.decision.best.regularities, shares, strict=True)
        return tuple(each for each, share in regularities if share >= self.interest)

    @property
    def added(self) -> tuple[Effect, ...]:
        """Effects and regularities that were added to the model of the order lines."""
        return self.decision.after.added

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The physical effects that were found, without small ones."""
        return (*self.of_orders, *(line.effect for line in self.lines))

    @property
    def of_orders(self) -> tuple[Effect, ...]:
        """Those that were found in the order lines."""
        return tuple(effect for effect in self.decision.effects if effect not in self.small)

    @property
    def bare_lines(self) -> tuple[LineBetween, ...]:
        """The interharmonic lines without a known cause, as effects that can be declared."""
        return tuple(part.effect for line in self.unnamed for part in line.parts)

    @property
    def unexplained(self) -> str:
        """The unexplained remainder in words; empty if there is no remainder."""
        return "; ".join(map(str, (*self.unknown, *self.unnamed)))

    @property
    def nearest(self) -> tuple[Option, float] | None:
        """If only regularities were found: the most probable answer with an effect, and its probability."""
        if self.of_orders or not self.unknown:
            return None
        return next((each for each in self.decision.answers if each[0].effects), None)


def answer(
    recordings: Sequence[Recording],
    unit: Unit,
    kinds: Sequence[type[Effect]],
    *,
    known: Sequence[Effect] = (),
    interest: float = INTEREST,
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
    interest : float
        Smallest change that matters (:data:`swgsim.identification.report.interest.INTEREST`).
    seed : int
    """
    forget()
    STEPS.info("searching interharmonic lines in %d recordings", len(recordings))
    N = unit.model.gear.transmission.N
    lines = search(gauge_spectra(recordings, N), kinds, ALPHA, known, gauge_spectra(unit.healthy, N))
    clean = all_cleaned(recordings, lines.effects, N)
    decision = decide(Measured.of(clean), unit, kinds, seed=seed)
    STEPS.info("describing the remainder")
    high = high_order_regularities(clean, unit.healthy, decision.before.model, decision.after.model, ALPHA, MOST_ABOVE)
    return Answer(decision, tuple(known), lines.named, lines.unnamed, high, untestable(decision), interest)


def untestable(decision: Decision) -> tuple[Score, ...]:
    """Effects that the recordings cannot test, without those in the credible set."""
    tested = {type(effect) for option, _ in decision.credible for effect in option.effects}
    return tuple(score for score in decision.scores if score.absorbed and score.hypothesis.kind not in tested)
