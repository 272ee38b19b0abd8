"""Waves over the angle of a joint to be tried as terms: whole orders of the output, and orders that stand out."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from swgsim.joint.effects.position_friction import PositionFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.orders import lines
from swgsim.joint.recording import turns_back
from swgsim.joint.regression import Fit
from swgsim.joint.shaping import gain, shaped
from swgsim.joint.term import Term

Wave = Ripple | PositionFriction
# Up to this order, waves are fixed to the output and repeat after its revolution: whole numbers, of which so many are
# tried in a round; the first one is gravity's.
SLOW, SLOW_ORDERS = 40, 2
# Above, so many lines are tried. An order is a whole number unless another one near it explains so many times as much.
ORDERS, OTHERWISE = 4, 1.25
# Orders of which the best ones are proposed.
LOOKED_AT = SLOW + ORDERS


def waves(now: Fit, level: float, known: dict[float, Wave]) -> list[Wave]:
    """Waves fixed to the output, and waves at orders that stand out of the residual.

    Parameters
    ----------
    now : Fit
    level : float
        Chance of a false order.
    known : dict
        Keeps what takes long to find: the wave of every order that was looked at.
    """
    slow = sorted((Ripple(order=float(n)) for n in range(2, SLOW + 1)), key=lambda term: -gain(now, term))
    laws: list[Wave] = [Ripple(), Ripple(power=1)]
    if now.table.of == "current" and turns_back(now.table.recordings):
        laws.append(PositionFriction())
    there = {_what(term) for term in now.terms}
    fast = []
    for line in lines(now.table, now.residual, level, ORDERS, above=SLOW):
        rough = _at_order(now, line.order, laws)
        if rough.order not in known or _what(known[rough.order]) in there:
            # A wave that is there already may leave one of another law at its order.
            known[rough.order] = _whole(now, shaped(now, rough))
        fast.append(known[rough.order])
    return [term for term in (*slow[:SLOW_ORDERS], *fast) if _what(term) not in there]


def _what(term: Term) -> tuple:
    """What makes two waves the same."""
    return type(term), getattr(term, "order", None), getattr(term, "power", None)


def _at_order(now: Fit, order: float, laws: Sequence[Wave]) -> Wave:
    """The wave at an order near one that gains most."""
    resolution = 2 * np.pi / max(float(np.ptp(each.signals["q"])) for each in now.table.recordings)
    near = order + resolution * np.linspace(-0.5, 0.5, 9)
    return max((replace(law, order=float(o)) for law in laws for o in near), key=lambda term: gain(now, term))


def _whole(now: Fit, wave: Wave) -> Wave:
    """The wave of the next whole order, if the recordings do not tell it from one."""
    whole = shaped(now, replace(wave, order=float(round(wave.order))))
    return wave if gain(now, wave) > OTHERWISE * gain(now, whole) else whole
