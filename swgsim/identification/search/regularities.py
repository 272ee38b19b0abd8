"""Regularities: description of a remainder by an order, a pattern over the channels and a law.

They are tested like effects of the library, with nuisance parameters marginalised. Together they are the most general
test of a residual.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby, product

import numpy as np
from jaxtyping import Complex, Float

from swgsim.common.chi2_logsf import surprise
from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import LAWS, PATTERNS, Regularity
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import LEAST_GAIN
from swgsim.identification.search.screening import LEAST_VISIBLE_SHARE


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


@dataclass(frozen=True)
class Described:
    """A regularity with its estimates from the residual.

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
        p-value of a regularity at high orders; nan for the orders of the model, which have probabilities.
    rivals : tuple of str
        Other laws that fit equally well.
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
        """Significance of the gain, for sorting."""
        return surprise(self.gain, self.freedom)

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
    """Regularities by significance, the most significant first; nuisance parameters are projected out."""
    measured, found = fitted.measured, []
    for order, group in groupby(atoms(measured.layout), key=lambda atom: atom.order):
        rows, own = np.tile(measured.layout.order == order, len(measured)), list(group)
        every = [columns(atom, fitted)[rows] for atom in own]
        ends, stacked = np.cumsum([C.shape[1] for C in every])[:-1], np.hstack(every)
        weighed = (np.split(errors.precision(rows) @ stacked, ends, axis=1) for errors in (fitted.whole, fitted.errors))
        for atom, C, whole, alone in zip(own, every, *weighed, strict=True):
            s2, V = np.linalg.eigh(C.T @ whole)
            kept = s2 > LEAST_VISIBLE_SHARE * max(float((C * alone).sum(axis=0).max()), 1e-300)
            # Along each of these directions a weighed residual has a standard deviation of 1.
            weights = V[:, kept] / np.sqrt(s2[kept])
            found.append(_described(atom, weights, (C @ weights).T @ fitted.weighed[rows]))
    return sorted(found, key=lambda each: -each.rank)


def other_laws(best: Described, others: Sequence[Described]) -> tuple[str, ...]:
    """By which others explain the same order and pattern as well."""
    same = [other for other in others if replace(other.atom, law=best.atom.law) == best.atom]
    return tuple(o.atom.law for o in same if o.atom != best.atom and best.gain - o.gain < as_squares(LEAST_GAIN))


def _described(
    atom: Atom, weights: Float[np.ndarray, "column direction"], along: Float[np.ndarray, " direction"]
) -> Described:
    """An atom, from how its columns make its directions and what the residual has along these."""
    fit = weights @ along
    amplitude = float(np.hypot(*fit) if len(fit) == 2 else abs(fit[0]))
    phase = float(np.arctan2(-fit[1], fit[0])) if len(fit) == 2 else float(np.pi * (fit[0] < 0))
    return Described(atom, float(along @ along), len(along), amplitude, phase)


def set_free(fitted: Fitted, described: Described) -> Fitted:
    """A fit with an atom as a nuisance direction, with the amplitude found as standard deviation."""
    taken = columns(described.atom, fitted) * max(described.amplitude, 1e-12)
    return fitted.allowing(taken)
