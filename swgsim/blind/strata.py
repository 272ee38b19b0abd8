"""The strata of a sealed set: number of cases of each kind, their strengths and their recordings."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

from swgsim.blind.outside import OUTSIDE
from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.interharmonics.named_interharmonics import has_sidelines, is_random

EASY_NULL, HARD_NULL, SINGLE, PAIR, TAKEN_OUT, WRITTEN, UNTESTABLE = (
    "easy null", "hard null", "single", "pair", "taken out", "written", "untestable",
)  # fmt: skip
NULLS, OUTSIDE_STRATA = (EASY_NULL, HARD_NULL), (TAKEN_OUT, WRITTEN)
# Twenty cases: 25 % nulls, 30 % single effects, 15 % pairs, 20 % outside the library, 10 % untestable.
CYCLE = (
    SINGLE, EASY_NULL, WRITTEN, PAIR, SINGLE, HARD_NULL, TAKEN_OUT, SINGLE, UNTESTABLE, HARD_NULL,
    SINGLE, PAIR, WRITTEN, EASY_NULL, SINGLE, TAKEN_OUT, PAIR, UNTESTABLE, HARD_NULL, SINGLE,
)  # fmt: skip
# Non-centrality of an effect, with nuisance parameters marginalised.
STRENGTHS = (60.0, 400.0, 3000.0, 30000.0)
# Smallest strength of a detectable effect.
DETECTABLE = 400.0
# Form of a library effect in the single stratum: the bench's mesh alone, or with a change of its law, or company.
FORMS = ("mesh", "load law", "scattered size", "stray order")


@dataclass(frozen=True)
class Design:
    """Operating points, and how often each is recorded."""

    name: str
    points: tuple[OperatingPoint, ...]
    repeats: int


def _design(name: str, speeds: Sequence[float], loads: Sequence[float], repeats: int) -> Design:
    return Design(name, tuple(OperatingPoint(n, T) for n, T in product(speeds, loads)), repeats)


FULL = _design("6 points", (2000.0, 4000.0), (7.0, 39.0, 70.0), 3)
DESIGNS = (
    FULL,
    _design("4 points", (2000.0, 4000.0), (7.0, 70.0), 3),
    _design("2 speeds", (2000.0, 4000.0), (39.0,), 3),
    _design("1 repeat", (2000.0, 4000.0), (7.0, 39.0, 70.0), 1),
)
# Of ten cases, so many have the full design, and one each has another one.
SHARE_OF_FULL = 7
SHARE_COMMISSIONED = 0.8
# Parameters that a unit never seen is declared not to know; their effects are untestable within the declared spread.
ABSORBED = (
    "gauge_gain", "zero_offset", "gauge_position", "gauge_direction", "reduced_damping", "reduced_stiffness",
    "flank_friction", "worn_wave_generator",
)  # fmt: skip


@dataclass(frozen=True)
class Plan:
    """The plan of a case before the simulation.

    Attributes
    ----------
    number : int
    stratum : str
    design : Design
    commissioned : bool
    strength : float
        Non-centrality that the size of each hidden effect is to bring.
    form : str
        Of :data:`FORMS`.
    kinds : tuple of type of Effect
        Hidden effects.
    """

    number: int
    stratum: str
    design: Design
    commissioned: bool
    strength: float
    form: str
    kinds: tuple[type[Effect], ...]


def plans(count: int, seed: int, library: Sequence[type[Effect]]) -> list[Plan]:
    """The cases of a set; more cases do not change the first ones.

    Effects are dealt like cards: none comes twice in a stratum before all others came once.
    """
    sought = [kind for kind in library if searched(kind)]
    absorbed = [kind for kind in sought if kind.name() in ABSORBED] or sought
    decks: dict[str, Sequence[type[Effect]]] = {
        SINGLE: sought,
        PAIR: sought,
        TAKEN_OUT: sought,
        WRITTEN: list(OUTSIDE),
        UNTESTABLE: absorbed,
    }
    dealt = dict.fromkeys(CYCLE, 0)
    numbers = dict.fromkeys(CYCLE, 0)
    found = []
    for number in range(count):
        stratum = CYCLE[number % len(CYCLE)]
        rng = generator("blind plan", seed, number)
        kinds = []
        for _ in range(0 if stratum in NULLS else 2 if stratum == PAIR else 1):
            kinds.append(_card(decks[stratum], dealt[stratum], seed, stratum))
            dealt[stratum] += 1
        nth = numbers[stratum]
        numbers[stratum] += 1
        design = FULL if rng.uniform() * 10 < SHARE_OF_FULL else DESIGNS[1 + int(rng.integers(len(DESIGNS) - 1))]
        commissioned = stratum != UNTESTABLE and bool(rng.uniform() < SHARE_COMMISSIONED)
        strength = STRENGTHS[int(generator("strength", seed, stratum, nth // 4).permutation(4)[nth % 4])]
        form = FORMS[int(rng.integers(len(FORMS)))] if stratum == SINGLE else FORMS[0]
        found.append(Plan(number, stratum, design, commissioned, strength, form, tuple(kinds)))
    return found


def _card(deck: Sequence[type[Effect]], dealt: int, seed: int, stratum: str) -> type[Effect]:
    """The next card of a deck that is shuffled anew whenever it has been dealt."""
    order = generator("deck", seed, stratum, dealt // len(deck)).permutation(len(deck))
    return deck[int(order[dealt % len(deck)])]


def searched(kind: type[Effect]) -> bool:
    """Whether the loop has a way to look for an effect: random phases within the chain have none."""
    return not is_random(kind) or has_sidelines(kind)
