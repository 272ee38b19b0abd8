"""Friction in sum, of terms that share it: Coulomb friction, Maxwell slip and Stribeck friction."""

from typing import Any

import numpy as np

from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.slip import MaxwellSlip
from swgsim.joint.regression import Fit
from swgsim.joint.term import Term
from swgsim.joint.textbook import Friction


def in_sum(top: Fit, unit: str) -> dict[str, dict[str, Any]]:
    """Friction after a long way, and at the lowest speeds, with 95 % intervals, if several terms share it.

    Over a long way Maxwell slip is constant, as Coulomb friction is, and at low speed Stribeck friction is. The
    recordings tell the sum well, and the parts badly.
    """
    sums: dict[str, tuple[type, ...]] = {
        "Coulomb friction with Maxwell slip": (MaxwellSlip,),
        "friction at low speed, with Stribeck friction": (StribeckFriction, MaxwellSlip),
    }
    found = {}
    for name, kinds in sums.items():
        if any(isinstance(term, kinds[0]) for term in top.terms):
            factors = np.concatenate([_factors(term, kinds) for term in top.terms])
            size, half = float(factors @ top.weights), float(top.half_intervals(factors[None])[0])
            found[name] = {"value": size, "ci95": [max(size - half, 0.0), size + half], "unit": unit}
    return found


def _factors(term: Term, kinds: tuple[type, ...]) -> np.ndarray:
    """1 for Coulomb friction and all weights of some kinds of terms, else 0."""
    factors = np.full(len(term.weights), float(isinstance(term, kinds)))
    if isinstance(term, Friction):
        factors[0] = 1.0
    return factors
