"""Proposals of effects whose lines differ one by one from the library's, on a gear of another structure.

The score test expects that an effect explains the residual down to the noise. There, it explains the lines that the
library has to some per cent, and says nothing of the others, however large they are. So size and phase are those that
leave the largest evidence with errors of lines.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.identification.decide.line_errors import LineErrors, groups
from swgsim.identification.decide.prior import LINE_ERROR, LOG_SIZE_RANGE, log_choices
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import Hypothesis, signatures
from swgsim.identification.search.refining import LEAST_SIZE, spacing

# Phases of a wave and sizes that are tried, these within such logarithms of the one that explains the largest group of
# lines; and rounds, each in so many times a narrower range.
PHASES, SIZES, SIZE_RANGE, ROUNDS, NARROWER = 48, 13, (-1.5, 1.0), 3, 4
# Places and shapes around one that are tried, in spacings of the screening.
AROUND = (-0.5, -0.25, 0.0, 0.25, 0.5)


@dataclass(frozen=True, eq=False)
class Proposal:
    """An effect that may be missing.

    Attributes
    ----------
    log_evidence : float
        That is expected of an option with it.
    effect : Effect
    start : Fitted
        Without it, with the errors of lines that it leaves.
    """

    log_evidence: float
    effect: Effect
    start: Fitted


@dataclass(frozen=True)
class _Found:
    """A hypothesis at its likeliest size, as a factor on its signature, and phase; 0 or pi is a sign if it has none."""

    log_likelihood: float
    hypothesis: Hypothesis
    times: float
    phase: float

    @property
    def size(self) -> float:
        """In the unit of the effect."""
        q = quantities(self.hypothesis.kind)[self.hypothesis.size]
        signed = self.times if self.hypothesis.phase else self.times * np.cos(self.phase)
        return float(np.clip(q.nothing + signed * (self.hypothesis.typical - q.nothing), q.low, q.high))


class LineProposals:
    """Effects that explain most of what the model of a unit leaves.

    Parameters
    ----------
    null : Fitted
        The model without effects.
    """

    def __init__(self, null: Fitted) -> None:
        self._fitted = null.with_zeros(1.0).closed
        self._groups = groups(self._fitted.measured)
        self._errors, self._directions = LineErrors.of(self._groups, self._fitted.whole.whiten(self._groups.columns))
        self._r = self._fitted.white
        self._along = self._directions.T @ self._r

    def leading(
        self, every: Sequence[Hypothesis], changes: Sequence[Float[np.ndarray, "row column"]], many: int
    ) -> list[Proposal]:
        """The most probable effects, at most so many, the most probable first.

        Parameters
        ----------
        every : sequence of Hypothesis
        changes : sequence of array (row, column)
            Their signatures.
        many : int
        """
        best: dict[type[Effect], _Found] = {}
        for each in self._likeliest(every, changes):
            known = best.get(each.hypothesis.kind)
            if known is None or each.log_likelihood > known.log_likelihood:
                best[each.hypothesis.kind] = each
        leading = sorted(best.values(), key=lambda each: -each.log_likelihood)[:many]
        found = [self._proposal(self._refined(each)) for each in leading]
        return sorted(found, key=lambda each: -each.log_evidence)

    def _proposal(self, found: _Found) -> Proposal:
        hypothesis = replace(found.hypothesis, reference=found.size)
        _, along, lines = self._of_signature(signatures([hypothesis], self._fitted.model, self._fitted.measured)[0])
        turned = np.array([np.cos(found.phase), np.sin(found.phase)]) if hypothesis.phase else np.ones(1)
        (largest,) = self._groups.largest((lines @ turned)[None]).tolist()
        off = self._errors.deviations(self._along - along @ turned, LINE_ERROR * largest)
        start = self._fitted.allowing_forms(self._errors.columns * off)
        prior = -log_choices(hypothesis.kind) - np.log(LOG_SIZE_RANGE)
        return Proposal(
            self._fitted.log_likelihood + found.log_likelihood + prior,
            hypothesis.effect(found.size, found.phase),
            start,
        )

    def _refined(self, found: _Found) -> _Found:
        """At the likeliest places and shapes around, with the signature at the size found."""
        declared = quantities(found.hypothesis.kind)
        another = self._fitted.unit.of_another_structure
        names = [n for n, q in declared.items() if q.role in (Role.ANGLE, Role.SHAPE) and q.open(another)]
        for scale in (1.0, 0.5) if names else ():
            around = []
            for steps in product(AROUND, repeat=len(names)):
                inner = dict(found.hypothesis.inner)
                for name, step in zip(names, steps, strict=True):
                    q = declared[name]
                    value = inner[name] + scale * step * spacing(q)
                    inner[name] = float(value % (2 * np.pi) if q.role is Role.ANGLE else np.clip(value, q.low, q.high))
                around.append(replace(found.hypothesis, inner=tuple(inner.items()), reference=found.size))
            changes = signatures(around, self._fitted.model, self._fitted.measured)
            found = max(self._likeliest(around, changes), key=lambda each: each.log_likelihood, default=found)
        return found

    def _of_signature(
        self, signature: Float[np.ndarray, "row column"]
    ) -> tuple[
        Float[np.ndarray, "row column"], Float[np.ndarray, "direction column"], Float[np.ndarray, "direction column"]
    ]:
        """Whitened, along the directions of line errors, and by the weights of groups."""
        x = self._fitted.whole.whiten(signature)
        return x, self._directions.T @ x, self._groups.weights.T @ signature

    def _likeliest(
        self, every: Sequence[Hypothesis], changes: Sequence[Float[np.ndarray, "row column"]]
    ) -> list[_Found]:
        """Every hypothesis that explains something."""
        found = (self._at_its_best(*each) for each in zip(every, changes, strict=True))
        return [each for each in found if each is not None]

    def _at_its_best(self, hypothesis: Hypothesis, signature: Float[np.ndarray, "row column"]) -> _Found | None:
        """A hypothesis at its likeliest size and phase; none if it explains nothing."""
        x, along, lines = self._of_signature(signature)
        if not along.any():
            return None
        phases, reach = self._phases(hypothesis), np.linspace(*SIZE_RANGE, SIZES)
        best = _Found(-np.inf, hypothesis, 0.0, 0.0)
        for number in range(ROUNDS):
            turned = np.stack([np.cos(phases), np.sin(phases)], axis=1)[:, : x.shape[1]]
            by_phase = turned @ along.T
            times = self._of_main_lines(by_phase) if number == 0 else np.full(len(phases), best.times)
            tried = np.minimum(np.maximum(times, 0.0)[:, None] * np.exp(reach), self._most(hypothesis))
            explained = tried * (turned @ (x.T @ self._r))[:, None]
            explained -= tried**2 * ((turned @ (x.T @ x)) * turned).sum(axis=1)[:, None] / 2
            left = self._along - tried[..., None] * by_phase[:, None]
            largest = self._groups.largest(turned @ lines.T)[:, None] * tried
            value = np.where(tried > 0, explained + self._errors.gain(left, LINE_ERROR * largest), -np.inf)
            i, j = np.unravel_index(value.argmax(), value.shape)
            if value[i, j] > best.log_likelihood:
                best = _Found(float(value[i, j]), hypothesis, float(tried[i, j]), float(phases[i]))
            phases, reach = best.phase + self._finer(hypothesis, number), reach / NARROWER
        q = quantities(hypothesis.kind)[hypothesis.size]
        return best if abs(best.size - q.nothing) > LEAST_SIZE * (q.high - q.low) else None

    def _of_main_lines(self, by_phase: Float[np.ndarray, "try direction"]) -> Float[np.ndarray, " try"]:
        """Size at which a signature explains its largest group of lines, for each phase."""
        product, square = (
            np.add.reduceat(by_phase * each, self._groups.first, axis=1) for each in (self._along, by_phase)
        )
        main = square.argmax(axis=1)[:, None]
        return (np.take_along_axis(product, main, 1) / np.take_along_axis(square, main, 1))[:, 0]

    @staticmethod
    def _phases(hypothesis: Hypothesis) -> Float[np.ndarray, " try"]:
        """Phases that are tried; those of an effect without one are its signs."""
        if hypothesis.phase:
            return np.linspace(0, 2 * np.pi, PHASES, endpoint=False)
        q = quantities(hypothesis.kind)[hypothesis.size]
        return np.array([0.0, np.pi])[: 1 + (q.low < q.nothing < q.high)]

    @staticmethod
    def _finer(hypothesis: Hypothesis, number: int) -> Float[np.ndarray, " try"]:
        """Phases about the best one that are tried after so many rounds."""
        return np.pi / PHASES / NARROWER**number * np.arange(-2, 3) if hypothesis.phase else np.zeros(1)

    @staticmethod
    def _most(hypothesis: Hypothesis) -> float:
        """Largest size, in that of the signature."""
        q = quantities(hypothesis.kind)[hypothesis.size]
        return max(q.high - q.nothing, q.nothing - q.low) / abs(hypothesis.typical - q.nothing)
