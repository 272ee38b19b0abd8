"""An open vocabulary for what no known effect explains: an order, a pattern over the gauges, and a law.

Atoms are tested as the effects of the library are, after projecting out what the declared parameters absorb. Together
they are also the widest question that can be asked of a residual: whether anything regular is left in it at all.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.frozen import FULL_LOAD
from swgsim.loop.features import ORDERS, Layout
from swgsim.loop.fitting import Fitted
from swgsim.loop.model import Situation
from swgsim.loop.screening import VISIBLE, family_wise
from swgsim.loop.tail import log_tail

# Gauges s1 to s4 sit a quarter turn apart; a pattern of m waves travels around them.
PATTERNS: Mapping[str, dict[str, complex]] = {
    "the same in s1 to s4": dict.fromkeys(("s1", "s2", "s3", "s4"), 1),
    "the same in all gauges": dict.fromkeys(("s0", "s1", "s2", "s3", "s4"), 1),
    "opposite in neighbours (two waves)": {"s1": 1, "s2": -1, "s3": 1, "s4": -1},
    "one wave that turns with the wave generator (or three against it)": {"s1": 1, "s2": -1j, "s3": -1, "s4": 1j},
    "one wave that turns against the wave generator (or three with it)": {"s1": 1, "s2": 1j, "s3": -1, "s4": -1j},
    "opposite in s1 and s3": {"s1": 1, "s3": -1},
    "opposite in s2 and s4": {"s2": 1, "s4": -1},
    **{f"in {name} alone": {name: 1} for name in ("s0", "s1", "s2", "s3", "s4", "T_in", "T_out", "n_in")},
}
SPEED, KELVIN, HOUR = 4000.0, 10.0, 3600.0
LAWS: Mapping[str, Callable[[Situation], float]] = {
    "constant": lambda s: 1.0,
    "proportional to the load": lambda s: s.point.T_out / FULL_LOAD,
    "with the square of the load": lambda s: (s.point.T_out / FULL_LOAD) ** 2,
    "with the root of the load": lambda s: (s.point.T_out / FULL_LOAD) ** 0.5,
    "proportional to the speed": lambda s: s.point.n_in_rpm / SPEED,
    "with the square of the speed": lambda s: (s.point.n_in_rpm / SPEED) ** 2,
    "proportional to load and speed": lambda s: s.point.T_out / FULL_LOAD * s.point.n_in_rpm / SPEED,
    "proportional to the temperature above 25 degC": lambda s: s.conditions.warmer / KELVIN,
    "proportional to the time since the session began": lambda s: s.conditions.elapsed / HOUR,
}


@dataclass(frozen=True)
class Atom:
    """One regularity.

    Attributes
    ----------
    order : int
        Of the wave generator's revolution; 0 is the mean.
    pattern : str
        Of :data:`PATTERNS`.
    law : str
        Of :data:`LAWS`.
    """

    order: int
    pattern: str
    law: str


@dataclass(frozen=True)
class Described:
    """An atom with what the residual says of it.

    Attributes
    ----------
    atom : Atom
    gain : float
        Fall of the residual's sum of squares.
    freedom : int
    chance : float
        Of as much by noise in the whole vocabulary.
    amplitude : float
        At 70 N m, 4000 rpm, 10 K, 1 h where the law has them [unit of the channel].
    phase : float
        [rad].
    """

    atom: Atom
    gain: float
    freedom: int
    chance: float
    amplitude: float
    phase: float

    @property
    def rank(self) -> float:
        """How unlikely the gain is by luck."""
        return -2 * float(log_tail(self.gain, self.freedom)) if self.freedom else 0.0

    def __str__(self) -> str:
        what = "the mean" if self.atom.order == 0 else f"order {self.atom.order}"
        unit = {"T": "N m", "n": "rpm"}.get(self.atom.pattern.removeprefix("in ")[:1], "mV/V")
        return f"{what}, {self.atom.pattern}, {self.atom.law}, amplitude {self.amplitude:.3g} {unit}"


def atoms(layout: Layout) -> list[Atom]:
    """All atoms that the channels can show."""
    shown = [name for name, pattern in PATTERNS.items() if set(pattern) <= set(layout.channels)]
    # A mean does not turn.
    return [Atom(*each) for each in product(range(ORDERS + 1), shown, LAWS) if each[0] or "turns" not in each[1]]


def columns(atom: Atom, fitted: Fitted) -> Float[np.ndarray, "row column"]:
    """Cosine and sine of an atom; the mean has its real patterns only."""
    measured = fitted.measured
    law = np.array([LAWS[atom.law](situation) for situation in measured.situations])
    found = []
    for turn in (1, 1j) if atom.order else (1,):
        lines: Complex[np.ndarray, "channel order"] = np.zeros((len(measured.layout.channels), ORDERS + 1), complex)
        for channel, weight in PATTERNS[atom.pattern].items():
            lines[measured.layout.channels.index(channel), atom.order] = turn * weight
        found.append(measured.rows(law[:, None] * measured.layout.vector(lines)))
    return np.stack(found, axis=1)


def describe(fitted: Fitted, rng: np.random.Generator) -> list[Described]:
    """Atoms by how unlikely they are by luck, the likeliest to be real first."""
    tried = atoms(fitted.measured.layout)
    blocks = [columns(atom, fitted) for atom in tried]
    stacked = np.hstack(blocks)
    ends = np.cumsum([block.shape[1] for block in blocks])[:-1]
    alone = (fitted.errors.whiten(stacked) ** 2).sum(axis=0)
    weighed = np.split(fitted.whole.whiten(stacked), ends, axis=1)
    r = fitted.whole.whiten(fitted.from_start)
    bases, fits = [], []
    for C, free in zip(weighed, np.split(alone, ends), strict=True):
        U, s, Vt = np.linalg.svd(C, full_matrices=False)
        kept = s**2 > VISIBLE * max(float(free.max()), 1e-300)
        U, s, Vt = U[:, kept], s[kept], Vt[kept]
        bases.append(U)
        fits.append(Vt.T @ ((U.T @ r) / s))
    chances = family_wise(bases, r, fitted, rng)
    found = [
        Described(
            atom, float(((U.T @ r) ** 2).sum()), U.shape[1], float(chance),
            float(np.hypot(*fit) if len(fit) == 2 else abs(fit[0])),
            float(np.arctan2(-fit[1], fit[0])) if len(fit) == 2 else float(np.pi * (fit[0] < 0)),
        )
        for atom, U, fit, chance in zip(tried, bases, fits, chances, strict=True)
    ]  # fmt: skip
    return sorted(found, key=lambda each: -each.rank)
