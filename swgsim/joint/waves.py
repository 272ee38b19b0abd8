"""Candidate waves over the angle of a joint: whole orders of the output, and orders that stand out of the residual."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from swgsim.joint.effects.friction import PositionFriction
from swgsim.joint.effects.ripple import InertiaRipple, Ripple
from swgsim.joint.orders import LEAKAGE_LINES, Line, lines
from swgsim.joint.recording import OF_DRIVE, turns_back
from swgsim.joint.regression import Fit, slow
from swgsim.joint.shaping import gain, shapes
from swgsim.joint.term import Term

Wave = Ripple | PositionFriction
# Waves up to this order are whole orders of the output; so many of them are tested in a round. Order 1 is gravity.
SLOW, SLOW_ORDERS = 40, 2
# Above, so many lines are tested. An order is a multiple of the motor's, or else a whole number, unless a free order
# near it explains so many times as much.
TESTED_LINES, OTHERWISE = 4, 1.25
# Orders that are looked at in a round, for the correction of p-values.
LOOKED_AT = SLOW + TESTED_LINES


def waves(now: Fit, level: float, known: dict[float, tuple[Wave, ...]]) -> list[tuple[Wave, ...]]:
    """Waves of whole orders of the output, and of orders that stand out of the residual, each in all its shapes.

    Parameters
    ----------
    now : Fit
    level : float
        Significance level of an order.
    known : dict
        Cache: the shapes of every order that was tested in earlier rounds.
    """
    longest = max(float(np.ptp(each.signals["q"])) for each in now.table.recordings)
    # Less than half of a wave is not told from gravity and the zero.
    orders = (float(n) for n in range(2, SLOW + 1) if n * longest >= np.pi)
    slow = sorted(map(Ripple, orders), key=lambda term: -gain(now, term))
    laws: list[Wave] = [Ripple(), Ripple(power=1)]
    if now.table.of in OF_DRIVE and turns_back(now.table.recordings):
        laws.append(PositionFriction().added_to(now.terms))
    if now.table.of in OF_DRIVE and all(map(InertiaRipple().possible, now.table.recordings)):
        laws.append(InertiaRipple())
    present = {_what(term) for term in now.terms}
    found: list[tuple[Wave, ...]] = [(term,) for term in slow[:SLOW_ORDERS] if _what(term) not in present]
    for line in _lines(now, level):
        rough = _at_order(now, line.order, laws)
        if rough.order not in known or any(_what(each) in present for each in known[rough.order]):
            # A wave in the model may leave one of another law at its order.
            known[rough.order] = tuple(each for each in _shapes(now, rough) if _what(each) not in present)
        if known[rough.order]:
            found.append(known[rough.order])
    return found


def _lines(now: Fit, level: float) -> list[Line]:
    """Lines of the residual, and of its part above 5 Hz: residual friction at low frequency hides the waves of a joint
    that reverses.
    """
    fast = now.residual - slow(now.table, now.residual)
    every = [
        line for part in (now.residual, fast) for line in lines(now.table, part, level / 2, TESTED_LINES, above=SLOW)
    ]
    found: list[Line] = []
    for line in sorted(every, key=lambda line: line.log_chance):
        if all(abs(line.order - other.order) > LEAKAGE_LINES * _resolution(now) for other in found):
            found.append(line)
    return found[:TESTED_LINES]


def _resolution(now: Fit) -> float:
    """Resolution of orders in the longest recording."""
    return 2 * np.pi / max(float(np.ptp(each.signals["q"])) for each in now.table.recordings)


def _what(term: Term) -> tuple:
    """Identity of a wave: kind, order and power of the speed."""
    return type(term), getattr(term, "order", None), getattr(term, "power", None)


def _at_order(now: Fit, order: float, laws: Sequence[Wave]) -> Wave:
    """The wave with the largest gain near an order."""
    near = order + _resolution(now) * np.linspace(-0.5, 0.5, 9)
    return max((replace(law, order=float(o)) for law in laws for o in near), key=lambda term: gain(now, term))


def _shapes(now: Fit, wave: Wave) -> tuple[Wave, ...]:
    """The most likely shapes of a wave, one for each law of speed, and the wave with constant amplitude: a sharp
    resonance may be most likely because it fits a few stretches only.

    Its order becomes the nearest multiple of the motor's revolutions, or else of the output's, if the recordings cannot
    separate the two.
    """
    found = shapes(now, wave)
    ratio = now.table.recordings[0].gear_ratio or 1.0
    orders = [whole * round(wave.order / whole) for whole in (ratio, 1.0)]
    for order in (float(order) for order in orders if abs(order - wave.order) < _resolution(now)):
        whole = shapes(now, replace(wave, order=order))
        if max(gain(now, each) for each in found) <= OTHERWISE * max(gain(now, each) for each in whole):
            found = whole
            break
    return tuple(dict.fromkeys((*found, type(wave)(order=found[0].order).added_to(now.terms))))
