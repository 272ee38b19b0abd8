"""Checks of the size of gauge signals: wrong units, gains far from those of the others, dead gauges."""

from collections.abc import Iterator

import numpy as np

from swgsim.recordings.checks.angle import angle_is_sound
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.order_2 import order_2
from swgsim.recordings.checks.thresholds import (
    GAUGE_GAIN,
    GAUGE_LARGEST,
    GAUGE_QUANTILES,
    GAUGE_SMALLEST,
    ORDER_2_SHARE,
)
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS


def gauge_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of the channels s0 to s4 of one recording."""
    lines = {sensor: abs(line) for sensor, line in order_2(recording).items()}
    usual = float(np.median(list(lines.values()))) if lines else 0.0
    for sensor in (sensor for sensor in SENSORS if sensor in recording.channels):
        values = recording.channels[sensor]
        if not np.ptp(values):
            continue
        half = float(np.ptp(np.quantile(values, GAUGE_QUANTILES))) / 2
        size = max(half, abs(float(np.median(values))) if sensor == "s0" else 0.0)
        if size > GAUGE_LARGEST or (sensor != "s0" and size < GAUGE_SMALLEST):
            yield _wrong_size(recording, sensor, size)
        elif sensor in lines and angle_is_sound(recording) and lines[sensor] < ORDER_2_SHARE * half:
            yield Defect(
                "gauge_without_order_2", "warn", recording.name, sensor,
                f"{lines[sensor]:.3g} of {half:.3g} mV/V at order 2", "a gauge that shows the two lobes most",
                "check bonding, wiring and noise of this gauge",
            )  # fmt: skip
        elif sensor in lines and not 1 / GAUGE_GAIN < lines[sensor] / usual < GAUGE_GAIN:
            yield Defect(
                "gauge_gain", "warn", recording.name, sensor, f"{lines[sensor]:.3g} mV/V at order 2",
                f"about {usual:.3g} mV/V, as the others", "check gain, bridge type and bonding of this gauge",
            )  # fmt: skip


def _wrong_size(recording: Recording, sensor: str, size: float) -> Defect:
    """A signal far too small or too large for mV/V."""
    large = size > GAUGE_LARGEST
    kind, unit = ("gauge_in_um_m", "um/m, uV/V or volts") if large else ("gauge_in_v_v", "V/V (or dead)")
    remedy = f"it is in {unit}: convert it, or read it through a column map"
    expected = f"from {GAUGE_SMALLEST:g} to {GAUGE_LARGEST:g} mV/V"
    return Defect(kind, "refuse", recording.name, sensor, f"a size of {size:.3g} mV/V", expected, remedy)
