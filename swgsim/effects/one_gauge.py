"""Effects on one gauge, or on all gauges alike."""

from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.gear.gear import Gear

# Number of a gauge that stands for all of them.
ALL = 5


def weights(sensor: int) -> Float[np.ndarray, "5 1"]:
    """1 for the gauge, or for all of them, 0 for the others."""
    return np.array([[float(sensor in (s, ALL))] for s in range(5)])


def with_gauge(gear: Gear, sensor: int, **changes: float) -> Gear:
    """The gear with new values of named properties of :class:`swgsim.flexspline.gauges.GaugeSet` for one sensor."""
    new: dict[str, Any] = {
        name: tuple(value if s == sensor else old for s, old in enumerate(getattr(gear.gauges, name)))
        for name, value in changes.items()
    }
    return replace(gear, gauges=replace(gear.gauges, **new))
