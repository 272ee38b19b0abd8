"""The inner parameters of a term at which it explains most of a residual."""

from dataclasses import replace
from itertools import product
from typing import Any, TypeVar

import numpy as np
from scipy.optimize import minimize

from swgsim.effects.quantity import Quantity, Role, quantities
from swgsim.joint.regression import Fit, rms
from swgsim.joint.term import Term

T = TypeVar("T", bound=Term)
# A parameter is searched in its logarithm if the ratio of its bounds is at least this.
WIDE = 10.0
# Evaluations after the grid search, for each parameter.
EVALUATIONS = 35


def shaped(now: Fit, term: T) -> T:
    """A term at its most likely inner parameters, added to the terms of a fit."""
    return max(shapes(now, term), key=lambda each: gain(now, each))


def shapes(now: Fit, term: T) -> list[T]:
    """A term at the most likely inner parameters for each of its choices: grid search, then simplex search.

    Parameters
    ----------
    now : Fit
    term : Term
        Parameters with a single declared value stay as they are.
    """
    searched = {name: q for name, q in quantities(type(term)).items() if q.role is Role.SHAPE and q.points > 1}
    choices = {name: q.tried for name, q in quantities(type(term)).items() if q.role is Role.CHOICE}
    # Parameters of accepted effects of the same kind are start values: waves pass the same filter.
    alike = [tuple(getattr(each, name) for name in searched) for each in now.terms if type(each) is type(term)]
    values = (*product(*map(_grid, searched.values())), *alike)
    best = [
        max((_with(term, (*choices, *searched), (*c, *v)) for v in values), key=lambda each: gain(now, each))
        for c in product(*choices.values())
    ]
    # Choices are compared at their own best parameters.
    return [_downhill(now, each, searched) if searched else each for each in best]


def gain(now: Fit, term: Term) -> float:
    """Fall of the mean square of the residual if a term were added."""
    C = now.table.columns(term)
    free = C - now.basis @ (now.basis.T @ C)
    # The columns are few: their products suffice, at a fraction of the work.
    s, V = np.linalg.eigh(free.T @ free)
    along = V.T @ (free.T @ now.residual)
    # A column that the other terms explain does not count.
    kept = s > 1e-10 * float((C**2).sum())
    return float((along[kept] ** 2 / s[kept]).sum()) / len(now.residual)


def _downhill(now: Fit, begin: T, searched: dict[str, Quantity]) -> T:
    """Result of a simplex search, if it is better than its start."""
    names, declared = list(searched), list(searched.values())
    x = np.array([_inner(q, getattr(begin, name)) for name, q in searched.items()])
    ends = np.array([[_inner(q, q.low), _inner(q, q.high)] for q in declared])
    step = (ends[:, 1] - ends[:, 0]) / [2 * (q.points - 1) for q in declared]
    inwards = np.where(x + step <= ends[:, 1], step, -step)

    def moved(x: np.ndarray) -> T:
        return _with(begin, names, [_outer(q, each) for q, each in zip(declared, x, strict=True)])

    options = {
        "initial_simplex": np.vstack([x, x + np.diag(inwards)]), "maxfev": EVALUATIONS * len(x),
        "xatol": 1e-3, "fatol": 1e-6 * rms(now.residual) ** 2,
    }  # fmt: skip
    found = minimize(lambda x: -gain(now, moved(x)), x, method="Nelder-Mead", bounds=ends, options=options)
    return max((begin, moved(found.x)), key=lambda each: gain(now, each))


def _with(term: T, names: Any, values: Any) -> T:
    """A term with other parameters."""
    return replace(term, **dict(zip(names, values, strict=True)))


def _grid(quantity: Quantity) -> list[float]:
    """Values of the grid search."""
    ends = _inner(quantity, quantity.low), _inner(quantity, quantity.high)
    return [_outer(quantity, x) for x in np.linspace(*ends, quantity.points)]


def _wide(quantity: Quantity) -> bool:
    return quantity.low > 0 and quantity.high / quantity.low >= WIDE


def _inner(quantity: Quantity, value: float) -> float:
    """A value on the scale of the search."""
    return float(np.log(value)) if _wide(quantity) else value


def _outer(quantity: Quantity, value: float) -> float:
    """A value from the scale of the search, within its bounds."""
    return float(np.clip(np.exp(value) if _wide(quantity) else value, quantity.low, quantity.high))
