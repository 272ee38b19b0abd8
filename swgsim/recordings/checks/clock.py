"""Checks of the time: lost samples and jitter of the clock."""

from collections.abc import Iterator

import numpy as np

from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.checks.thresholds import GAP, JITTER_REFUSES, JITTER_WARNS, SHORT_STEP
from swgsim.recordings.recording import Recording
from swgsim.tables.file_defect import FIRST_ROW


def clock_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of uneven time steps."""
    steps = np.diff(recording.time)
    usual = float(np.median(steps))
    ratio = steps / usual
    gaps = np.flatnonzero(ratio > GAP)
    if len(gaps):
        lost = int(np.sum(np.round(ratio[gaps]) - 1))
        known = lost <= recording.lost
        yield Defect(
            "readings_left_out" if known else "samples_dropped", "warn" if known else "refuse", recording.name, "t",
            f"{len(gaps)} gaps with about {lost} lost samples, the first of {steps[gaps[0]]:.3g} s",
            f"steps of {usual:.3g} s",
            "their readings were lost, and the map leaves them out" if known
            else "record again without losses, or cut the recording before the first gap",
            int(gaps[0]) + 1 + FIRST_ROW,
        )  # fmt: skip
    short = np.flatnonzero(ratio < SHORT_STEP)
    even = ratio[(ratio <= GAP) & (ratio >= SHORT_STEP)]
    jitter = float(np.sqrt(np.mean((even - 1) ** 2)))
    if len(short) or jitter > JITTER_WARNS:
        severity: Severity = "refuse" if len(short) or jitter > JITTER_REFUSES else "warn"
        worst = int(short[0]) if len(short) else int(np.argmax(np.abs(ratio - 1)))
        yield Defect(
            "clock_jitter", severity, recording.name, "t",
            f"steps that differ by {100 * jitter:.2g} % rms, one of {steps[worst]:.3g} s",
            f"even steps of {usual:.3g} s", "sample by a hardware clock, or write the time with more digits",
            worst + 1 + FIRST_ROW,
        )  # fmt: skip
