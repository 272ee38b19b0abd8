"""The hypotheses of the library: every effect at typical size, for several values of its inner parameters.

Effects whose signature depends on their size have hypotheses at further sizes.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, predict_with_others


@dataclass(frozen=True)
class Hypothesis:
    """One effect with its inner parameters fixed; only its size, and the phase of a wave, are open.

    Attributes
    ----------
    kind : type of Effect
    inner : tuple of (name, value)
        Fixed parameters.
    tried : int
        Number of hypotheses of the same effect.
    reference : float, optional
        Size at which its signature is taken, the typical one if not given.
    """

    kind: type[Effect]
    inner: tuple[tuple[str, float], ...]
    tried: int
    reference: float | None = None

    @property
    def size(self) -> str:
        """Name of the size."""
        return size_of(self.kind)

    @property
    def phase(self) -> str | None:
        """Name of the phase, if the effect is a wave."""
        return next((name for name, q in quantities(self.kind).items() if q.role is Role.PHASE), None)

    @property
    def typical(self) -> float:
        """Size at which the signature is taken."""
        return quantities(self.kind)[self.size].typical if self.reference is None else self.reference

    def effect(self, size: float | None = None, phase: float = 0.0) -> Effect:
        """The effect of a size, typical if none is given."""
        values = dict(self.inner) | {self.size: self.typical if size is None else size}
        if self.phase:
            values[self.phase] = phase
        return self.kind(**values)

    @property
    def columns(self) -> tuple[Effect, ...]:
        """Effects whose signatures span those of any phase."""
        return (self.effect(), self.effect(phase=np.pi / 2)) if self.phase else (self.effect(),)

    def repeats(self, effect: Effect) -> bool:
        """Whether an effect is the same thing: of its kind and choices, without a place or shape that may be another
        one, so that two of them are one of another size.
        """
        declared = quantities(self.kind)
        return type(effect) is self.kind and all(
            (declared[name].role is Role.CHOICE or declared[name].of_structure or len(declared[name].tried) == 1)
            and getattr(effect, name) == value
            for name, value in self.inner
        )

    def __str__(self) -> str:
        inner = ", ".join(f"{name} {value:.3g}" for name, value in self.inner)
        return self.kind.title() + (f" ({inner})" if inner else "")


def hypotheses(kinds: Iterable[type[Effect]], another_structure: bool = False) -> Iterator[Hypothesis]:
    """All combinations of inner parameters that are tried, effect by effect; those with random phases are left out.

    Parameters
    ----------
    kinds : iterable of effect classes
    another_structure : bool
        Whether the gear's structure is another one than the model's.
    """
    for kind in kinds:
        declared = quantities(kind)
        if any(q.role is Role.RANDOM for q in declared.values()):
            continue
        inner = {
            n: (q.typical,) if q.of_structure and not another_structure else q.tried
            for n, q in declared.items()
            if q.role in (Role.ANGLE, Role.SHAPE, Role.CHOICE)
        }
        combinations = list(product(declared[size_of(kind)].tried, *inner.values()))
        for size, *values in combinations:
            yield Hypothesis(kind, tuple(zip(inner, values, strict=True)), len(combinations), size)


def signatures(found: Sequence[Hypothesis], model: Model, measured: Measured) -> list[Float[np.ndarray, "row column"]]:
    """How typical sizes of all hypotheses change the features of all recordings, by the chain itself.

    An effect with which the gear has no steady state changes nothing: no recording shows it.
    """
    if not found:
        return []
    effects = [effect for hypothesis in found for effect in hypothesis.columns]
    with_effect = [model.plus(effect) for effect in effects]
    predicted, beside = predict_with_others(model, with_effect, measured.situations, measured.layout)
    changes = np.where(np.isnan(beside), 0.0, beside - predicted)
    ends = np.cumsum([len(hypothesis.columns) for hypothesis in found])[:-1]
    return [measured.rows(np.moveaxis(part, 0, -1)) for part in np.split(changes, ends)]
