"""The inner parameters of a term: those at which it explains most of a residual."""

from dataclasses import replace
from itertools import product
from typing import Any, TypeVar

import numpy as np
from scipy.optimize import minimize

from swgsim.effects.quantity import Quantity, Role, quantities
from swgsim.joint.regression import Fit
from swgsim.joint.term import Term

T = TypeVar("T", bound=Term)
# A parameter whose bounds lie so many times apart is searched in its logarithm.
WIDE = 10.0
# Evaluations of a search beyond its grid, for each parameter.
ROUNDS = 35


def shaped(now: Fit, term: T) -> T:
    """A term at its likeliest inner parameters beside the terms of a fit."""
    return max(shapes(now, term), key=lambda each: gain(now, each))


def shapes(now: Fit, term: T) -> list[T]:
    """A term at the likeliest inner parameters of each of its choices: best of a grid, then downhill from there.

    Parameters
    ----------
    now : Fit
    term : Term
        Parameters that declare no values to try stay as they are.
    """
    searched = {name: q for name, q in quantities(type(term)).items() if q.role is Role.SHAPE and q.points > 1}
    choices = {name: q.tried for name, q in quantities(type(term)).items() if q.role is Role.CHOICE}
    # Where effects of the same kind were found is where this one may be: waves pass the same filter.
    alike = [tuple(getattr(each, name) for name in searched) for each in now.terms if type(each) is type(term)]
    values = (*product(*map(_grid, searched.values())), *alike)
    best = [
        max((_with(term, (*choices, *searched), (*c, *v)) for v in values), key=lambda each: gain(now, each))
        for c in product(*choices.values())
    ]
    # A choice shows its worth only at the parameters that suit it.
    return [_downhill(now, each, searched) if searched else each for each in best]


def gain(now: Fit, term: Term) -> float:
    """Fall of the mean square of the residual if a term were added."""
    C = now.table.columns(term)
    free = C - now.basis @ (now.basis.T @ C)
    # The columns are few: their products say all, at a fraction of the work.
    s, V = np.linalg.eigh(free.T @ free)
    along = V.T @ (free.T @ now.residual)
    # What the other terms absorb of a column is no column of its own.
    kept = s > 1e-10 * float((C**2).sum())
    return float((along[kept] ** 2 / s[kept]).sum()) / len(now.residual)


def _downhill(now: Fit, begin: T, searched: dict[str, Quantity]) -> T:
    """The term of a simplex search, if it is better than where that began."""
    names, declared = list(searched), list(searched.values())
    x = np.array([_inner(q, getattr(begin, name)) for name, q in searched.items()])
    ends = np.array([[_inner(q, q.low), _inner(q, q.high)] for q in declared])
    step = (ends[:, 1] - ends[:, 0]) / [2 * (q.points - 1) for q in declared]
    inwards = np.where(x + step <= ends[:, 1], step, -step)

    def moved(x: np.ndarray) -> T:
        return _with(begin, names, [_outer(q, each) for q, each in zip(declared, x, strict=True)])

    options = {
        "initial_simplex": np.vstack([x, x + np.diag(inwards)]), "maxfev": ROUNDS * len(x),
        "xatol": 1e-3, "fatol": 1e-6 * now.error**2,
    }  # fmt: skip
    found = minimize(lambda x: -gain(now, moved(x)), x, method="Nelder-Mead", bounds=ends, options=options)
    return max((begin, moved(found.x)), key=lambda each: gain(now, each))


def _with(term: T, names: Any, values: Any) -> T:
    """A term with other parameters."""
    return replace(term, **dict(zip(names, values, strict=True)))


def _grid(quantity: Quantity) -> list[float]:
    """Values that are tried first."""
    ends = _inner(quantity, quantity.low), _inner(quantity, quantity.high)
    return [_outer(quantity, x) for x in np.linspace(*ends, quantity.points)]


def _wide(quantity: Quantity) -> bool:
    return quantity.low > 0 and quantity.high / quantity.low >= WIDE


def _inner(quantity: Quantity, value: float) -> float:
    """A value in the measure of the search."""
    return float(np.log(value)) if _wide(quantity) else value


def _outer(quantity: Quantity, value: float) -> float:
    """A value from the measure of the search, within its bounds."""
    return float(np.clip(np.exp(value) if _wide(quantity) else value, quantity.low, quantity.high))
