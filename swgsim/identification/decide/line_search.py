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
from swgsim.identification.decide.option import Option
from swgsim.identification.decide.prior import LINE_ERROR, log_choices
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import Hypothesis, signatures
from swgsim.identification.search.refining import spacing

# Phases of a wave and sizes that are tried, about the size that explains the largest group of lines; and rounds, each
# of a quarter of the range of the last one.
PHASES, SIZES, SIZE_RANGE, ROUNDS = 48, 13, (-1.5, 1.0), 3
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
    log_likelihood: float
    hypothesis: Hypothesis
    times: float
    phase: float

    @property
    def size(self) -> float:
        q = quantities(self.hypothesis.kind)[self.hypothesis.size]
        return float(np.clip(q.nothing + self.times * (self.hypothesis.typical - q.nothing), q.low, q.high))


class LineSearch:
    """Effects beside those of an option.

    Parameters
    ----------
    base : Option
    """

    def __init__(self, base: Option) -> None:
        self._fitted = base.fitted.with_zeros(1.0).closed
        self._groups = groups(self._fitted.measured)
        self._errors = LineErrors.of(self._fitted.whole.whiten(self._groups.columns), self._groups)
        self._r = self._fitted.white
        self._along = self._errors.directions.T @ self._r

    def proposals(
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
        return [self._proposal(self._refined(each)) for each in leading]

    def _proposal(self, found: _Found) -> Proposal:
        hypothesis = replace(found.hypothesis, reference=found.size)
        x, along, sizes = self._of_signature(signatures([hypothesis], self._fitted.model, self._fitted.measured)[0])
        phase = np.array([np.cos(found.phase), np.sin(found.phase)])[: x.shape[1]]
        error = LINE_ERROR * float(self._groups.largest(sizes @ phase))
        off = self._errors.deviations(self._along - along @ phase, error)
        start = self._fitted.allowing_forms(self._errors.columns * off)
        evidence = self._fitted.log_likelihood + found.log_likelihood - log_choices(hypothesis.kind)
        return Proposal(evidence, hypothesis.effect(found.size, found.phase), start)

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

    def _of_signature(self, signature: Float[np.ndarray, "row column"]) -> tuple[Float[np.ndarray, "row column"], ...]:
        """Whitened, along the directions of line errors, and by the weights of groups."""
        x = self._fitted.whole.whiten(signature)
        return x, self._errors.directions.T @ x, self._groups.weights.T @ signature

    def _likeliest(
        self, every: Sequence[Hypothesis], changes: Sequence[Float[np.ndarray, "row column"]]
    ) -> list[_Found]:
        """Every hypothesis at its likeliest size and phase; none that explains nothing."""
        found = (self._at_its_best(*each) for each in zip(every, changes, strict=True))
        return [each for each in found if each is not None]

    def _at_its_best(self, hypothesis: Hypothesis, signature: Float[np.ndarray, "row column"]) -> _Found | None:
        q = quantities(hypothesis.kind)[hypothesis.size]
        span = hypothesis.typical - q.nothing
        x, along, sizes = self._of_signature(signature)
        if not np.abs(along).max() > 0:
            return None
        most = max((q.high - q.nothing) / span, (q.low - q.nothing) / span)
        phases = np.linspace(0, 2 * np.pi, PHASES, endpoint=False) if hypothesis.phase else np.zeros(1)
        times = None
        best: tuple[float, float, float] | None = None
        for number in range(ROUNDS):
            turned = np.stack([np.cos(phases), np.sin(phases)], axis=1)[:, : x.shape[1]]
            by_phase = turned @ along.T
            if times is None:
                main = np.add.reduceat(by_phase**2, self._groups.first, axis=1).argmax(axis=1)
                group = np.repeat(np.arange(len(self._groups.first)), self._groups.sizes)
                of_main = group == main[:, None]
                start = (by_phase * self._along * of_main).sum(axis=1) / (by_phase**2 * of_main).sum(axis=1)
            else:
                start = np.full(len(phases), times)
            spread = np.exp(np.linspace(*SIZE_RANGE, SIZES) / 4**number if number else np.linspace(*SIZE_RANGE, SIZES))
            tried = np.minimum(start[:, None] * spread, most)
            kept = np.flatnonzero(start > 0)
            if not len(kept):
                return None
            tried, turned, by_phase, phases = tried[kept], turned[kept], by_phase[kept], phases[kept]
            size = self._groups.largest(turned @ sizes.T)[:, None] * tried
            left = self._along - tried[..., None] * by_phase[:, None]
            with_x, of_x = turned @ (x.T @ self._r), ((turned @ (x.T @ x)) * turned).sum(axis=1)
            value = tried * with_x[:, None] - tried**2 * of_x[:, None] / 2
            value = value + self._errors.gain(left, LINE_ERROR * size)
            i, j = np.unravel_index(value.argmax(), value.shape)
            if best is None or value[i, j] > best[0]:
                best = float(value[i, j]), float(tried[i, j]), float(phases[i])
            times = best[1]
            step = 2 * np.pi / PHASES / 4**number / 2
            phases = best[2] + step * np.arange(-2, 3) if hypothesis.phase else np.array([best[2]])
        assert best is not None
        return _Found(best[0], hypothesis, best[1], float(best[2] % (2 * np.pi)))
