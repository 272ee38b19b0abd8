"""An open vocabulary for what no known effect explains: an order, a pattern over the gauges, and a law.

Atoms are tested as the effects of the library are, after projecting out what the declared parameters absorb. Together
they are also the widest question that can be asked of a residual: whether anything regular is left in it at all.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from jaxtyping import Complex, Float

from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import LAWS, PATTERNS, Regularity
from swgsim.loop.evidence import LEAST_GAIN
from swgsim.loop.features import ORDERS, Layout
from swgsim.loop.fitting import Fitted, extended
from swgsim.loop.leading import ALPHA
from swgsim.loop.screening import VISIBLE, family_wise
from swgsim.loop.tail import log_tail
from swgsim.seeds import generator
from swgsim.singular import svd

# Prior standard deviation of an atom that is set free, in amplitudes found.
WIDE = 100.0


@dataclass(frozen=True)
class Atom:
    """One regularity.

    Attributes
    ----------
    order : int
        Of the wave generator's revolution; 0 is the mean.
    pattern : str
        Of :data:`swgsim.effects.regularity.PATTERNS`.
    law : str
        Of :data:`swgsim.effects.regularity.LAWS`.
    """

    order: int
    pattern: str
    law: str

    @property
    def alone(self) -> bool:
        """Whether it is in one channel only, as a disturbance of one instrument is."""
        return len(PATTERNS[self.pattern]) == 1


@dataclass(frozen=True)
class Described:
    """An atom with what the residual says of it.

    Attributes
    ----------
    atom : Atom
    gain : float
        Fall of the residual's sum of squares.
    freedom : int
    amplitude : float
        At 70 N m, 4000 rpm, 10 K, 1 h where the law has them [unit of the channel].
    phase : float
        [rad].
    chance : float
        Of as much by noise in the whole vocabulary; nan where nobody asked.
    rivals : tuple of str
        Other laws that explain the same order and pattern as well.
    """

    atom: Atom
    gain: float
    freedom: int
    amplitude: float
    phase: float
    chance: float = np.nan
    rivals: tuple[str, ...] = ()

    @property
    def rank(self) -> float:
        """How unlikely the gain is by luck."""
        return -2 * float(log_tail(self.gain, self.freedom)) if self.freedom else 0.0

    @property
    def effect(self) -> Regularity:
        """The atom as an effect that a model can be given."""
        # A mean has no phase but a sign.
        sign, phase = (1.0, self.phase) if self.atom.order else (float(np.cos(self.phase)), 0.0)
        bound = quantities(Regularity)["amplitude"].high
        amplitude = sign * min(self.amplitude, bound)
        return Regularity(int(self.atom.order), amplitude, phase, self.atom.pattern, self.atom.law)

    def __str__(self) -> str:
        what = "the mean" if self.atom.order == 0 else f"order {self.atom.order}"
        unit = {"T": "N m", "n": "rpm"}.get(self.atom.pattern.removeprefix("in ")[:1], "mV/V")
        law = self.atom.law + (f" (or {', or '.join(self.rivals)})" if self.rivals else "")
        return f"{what}, {self.atom.pattern}, {law}, amplitude {self.amplitude:.3g} {unit}"


def atoms(layout: Layout) -> list[Atom]:
    """All atoms that the channels can show."""
    shown = [name for name, pattern in PATTERNS.items() if set(pattern) <= set(layout.channels)]
    # A mean does not turn.
    return [Atom(*each) for each in product(range(ORDERS + 1), shown, LAWS) if each[0] or "turns" not in each[1]]


def columns(atom: Atom, fitted: Fitted) -> Float[np.ndarray, "row column"]:
    """Cosine and sine of an atom; the mean has its real patterns only."""
    measured = fitted.measured
    law = np.array([LAWS[atom.law](s.point, s.conditions) for s in measured.situations])
    found = []
    for turn in (1, 1j) if atom.order else (1,):
        lines: Complex[np.ndarray, "channel order"] = np.zeros((len(measured.layout.channels), ORDERS + 1), complex)
        for channel, weight in PATTERNS[atom.pattern].items():
            lines[measured.layout.channels.index(channel), atom.order] = turn * weight
        found.append(measured.rows(law[:, None] * measured.layout.vector(lines)))
    return np.stack(found, axis=1)


def describe(fitted: Fitted) -> list[Described]:
    """Atoms by how unlikely they are by luck, the likeliest to be real first."""
    return [described for described, _ in _described(fitted)]


def strongest(fitted: Fitted, rng: np.random.Generator) -> Described:
    """The atom that is least likely by luck, with its chance and its rivals."""
    found = _described(fitted)
    chances = family_wise([U for _, U in found], fitted.whole.whiten(fitted.from_start), fitted, rng)
    best, *others = (described for described, _ in found)
    rivals = tuple(
        other.atom.law
        for other in others
        if replace(other.atom, law=best.atom.law) == best.atom and best.gain - other.gain < 2 * LEAST_GAIN
    )
    return replace(best, chance=float(chances[0]), rivals=rivals)


def left(fitted: Fitted, seed: int, most: int) -> tuple[Described, ...]:
    """Atoms that are no luck, the likeliest first; each is taken out before the next is sought."""
    found: list[Described] = []
    while len(found) < most:
        best = strongest(fitted, generator("vocabulary", seed, len(found)))
        if best.chance > ALPHA:
            break
        found.append(best)
        fitted = freed(fitted, best)
    return tuple(found)


def _described(fitted: Fitted) -> list[tuple[Described, Float[np.ndarray, "row _"]]]:
    """Atoms in this order, with the directions of the weighed residual that each may take."""
    tried = atoms(fitted.measured.layout)
    blocks = [columns(atom, fitted) for atom in tried]
    stacked = np.hstack(blocks)
    ends = np.cumsum([block.shape[1] for block in blocks])[:-1]
    alone = (fitted.errors.whiten(stacked) ** 2).sum(axis=0)
    weighed = np.split(fitted.whole.whiten(stacked), ends, axis=1)
    r = fitted.whole.whiten(fitted.from_start)
    found = []
    for atom, C, free in zip(tried, weighed, np.split(alone, ends), strict=True):
        U, s, Vt = svd(C)
        kept = s**2 > VISIBLE * max(float(free.max()), 1e-300)
        U, s, Vt = U[:, kept], s[kept], Vt[kept]
        along = U.T @ r
        fit = Vt.T @ (along / s)
        amplitude = float(np.hypot(*fit) if len(fit) == 2 else abs(fit[0]))
        phase = float(np.arctan2(-fit[1], fit[0])) if len(fit) == 2 else float(np.pi * (fit[0] < 0))
        found.append((Described(atom, float(along @ along), U.shape[1], amplitude, phase), U))
    return sorted(found, key=lambda each: -each[0].rank)


def set_free(fitted: Fitted, described: Described) -> Fitted:
    """A fit in which an atom may be as large as it likes, also when effects are added to it."""
    taken = columns(described.atom, fitted) * max(described.amplitude, 1e-12) * WIDE
    return fitted.allowing(taken)


def freed(fitted: Fitted, described: Described) -> Fitted:
    """The same fitted again, so that parameters that the atom had bent come back."""
    return extended(set_free(fitted, described), ())
