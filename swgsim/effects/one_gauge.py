"""One bridge of a gear's gauge set, changed."""

from dataclasses import replace
from typing import Any

from swgsim.gear import Gear


def with_gauge(gear: Gear, sensor: int, **changes: float) -> Gear:
    """The gear with new values of named properties of :class:`swgsim.gauges.GaugeSet` for one sensor."""
    new: dict[str, Any] = {
        name: tuple(value if s == sensor else old for s, old in enumerate(getattr(gear.gauges, name)))
        for name, value in changes.items()
    }
    return replace(gear, gauges=replace(gear.gauges, **new))
