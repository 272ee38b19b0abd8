"""Terms in words, and orders as multiples of the revolutions of the parts of a gear."""

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import Any

from swgsim.common.numbers import significant
from swgsim.joint.effects.friction import PositionFriction
from swgsim.joint.effects.ripple import Ripple
from swgsim.joint.term import Term

# An order counts as a multiple of a revolution within this difference.
ORDER_TOLERANCE = 0.5
# Highest named multiple of a revolution of the motor.
HIGHEST_MULTIPLE = 30


def in_words(term: Term, gear_ratio: float | None) -> str:
    """A term with its order, if it has one, and the part that turns with it."""
    if not isinstance(term, Ripple | PositionFriction):
        return term.title()
    part = part_of(term.order, gear_ratio)
    return f"{term.title()} of order {term.order:.6g}" + (f" ({part})" if part else "")


def part_of(order: float, gear_ratio: float | None) -> str:
    """Part that turns with an order: output, motor, or the wave generator relative to the flex spline; else empty.

    The wave generator turns with the motor. Relative to a flex spline that is the output, it makes one more revolution
    per revolution of the output. An ellipse repeats twice in each revolution.
    """
    if gear_ratio is not None:
        for ratio, what in ((gear_ratio, "motor"), (gear_ratio + 1, "wave generator in the flex spline")):
            multiple = round(order / ratio)
            if 1 <= multiple <= HIGHEST_MULTIPLE and abs(order - multiple * ratio) < ORDER_TOLERANCE:
                return f"{multiple} per revolution of the {what}"
    return f"{round(order)} per revolution of the output" if order == round(order) else ""


def listed(terms: Iterable[Term], gear_ratio: float | None) -> str:
    """Several terms in words; waves of one kind and one part together."""
    waves: dict[str, list[str]] = {}
    for term in terms:
        if isinstance(term, Ripple | PositionFriction):
            part = part_of(term.order, gear_ratio)
            number, _, of = part.partition(" ") if part else (f"{term.order:.6g}", "", "per revolution of the output")
            waves.setdefault(f"{term.title()} {of}", []).append(number)
        else:
            waves.setdefault(term.title(), [])
    named = []
    for what, numbers in waves.items():
        kind, _, of = what.partition(" per ")
        numbers = [f"{number:g}" for number in sorted({float(number) for number in numbers})]
        named.append(f"{kind} of {enumerated(numbers)} per {of}" if of else what)
    return enumerated(named)


def sizes(effect: Mapping[str, Any]) -> str:
    """The weights of an effect of a report, with their intervals, and angles in degrees.

    >>> weight = {"value": 0.05111, "ci95": [0.0506, 0.0516], "unit": "A/(N m)"}
    >>> sizes({"parameters": {"load_dependent_friction": weight, "distance": {"value": 2e-4, "ci95": None}}})
    '0.0511 A/(N m) (95 %: 0.0506 to 0.0516)'
    """
    weights = {name: each for name, each in effect["parameters"].items() if each["ci95"]}
    texts = []
    for name, each in weights.items():
        factor, unit = (180 / pi, "°") if each["unit"] == "rad" else (1.0, f" {each['unit']}")
        value, low, high = (significant(factor * number) for number in (each["value"], *each["ci95"]))
        text = f"{value}{unit} (95 %: {low} to {high})"
        texts.append(f"{name.replace('_', ' ')} {text}" if weights.keys() - {name} else text)
    return ", ".join(texts)


def enumerated(words: Sequence[str]) -> str:
    """Words in one line.

    >>> enumerated(["a", "b", "c"])
    'a, b and c'
    """
    *first, last = words or [""]
    return f"{', '.join(first)} and {last}" if first else last
