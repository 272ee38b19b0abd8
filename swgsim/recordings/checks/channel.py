"""Checks of every channel: clipped, stuck or constant values."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.thresholds import CLIPPED_EDGE, CLIPPED_REFUSES, CLIPPED_RUN, STUCK_RUN, STUCK_TURN
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS
from swgsim.tables.file_defect import FIRST_ROW


def channel_defects(recording: Recording) -> Iterator[Defect]:
    """Defects of every channel of a recording."""
    turn = 60 / recording.point.n_in_rpm * recording.rate
    for name, values in recording.channels.items():
        if not np.ptp(values):
            yield _constant(recording, name, float(values[0]))
            continue
        if name == "phi_in":
            continue
        starts, lengths = runs(values)
        cut = [row for sign in (1, -1) if (row := plateau(sign * values, starts, lengths)) is not None]
        if cut:
            share = float(np.isin(values, values[cut]).mean())
            mild = name in SENSORS and share < CLIPPED_REFUSES  # The library has an effect of it.
            yield Defect(
                "clipped", "warn" if mild else "refuse", recording.name, name,
                f"{values[cut[0]]:.5g} in a row between steep flanks, {100 * share:.2g} % of the samples cut",
                "a signal within the range of the amplifier", "lower the gain or widen the range, and record again",
                cut[0] + FIRST_ROW,
            )  # fmt: skip
        elif name in SENSORS[1:] and lengths.max() > max(STUCK_RUN, STUCK_TURN * turn):
            row = int(starts[np.argmax(lengths)])
            yield Defect(
                "stuck", "refuse", recording.name, name, f"{lengths.max()} times {values[row]:.5g} in a row",
                "a gauge that follows the wave generator", "check the connection, and record again", row + FIRST_ROW,
            )  # fmt: skip


def _constant(recording: Recording, name: str, value: float) -> Defect:
    """Refusal of a constant gauge or angle, warning for a constant torque or speed, which may be the set value."""
    if name in (*SENSORS, "phi_in"):
        return Defect(
            "stuck", "refuse", recording.name, name, f"{value:.5g} throughout", "a signal that changes",
            "check the connection, or leave the channel out", FIRST_ROW,
        )  # fmt: skip
    return Defect(
        "constant", "warn", recording.name, name, f"{value:.5g} throughout", "a measurement",
        "leave the channel out if it is only the set value",
    )  # fmt: skip


def runs(values: Float[np.ndarray, " time"]) -> tuple[np.ndarray, np.ndarray]:
    """Start and length of each run of equal values.

    >>> runs(np.array([3.0, 3.0, 1.0]))
    (array([0, 2]), array([2, 1]))
    """
    starts = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1])
    return starts, np.diff(starts, append=len(values))


def plateau(values: Float[np.ndarray, " time"], starts: np.ndarray, lengths: np.ndarray) -> int | None:
    """First sample of the longest run at the maximum, if the signal is clipped there.

    The peak of a digitised signal is flat too, within one step of the converter, and noise may hit the same level by
    chance. Let a parabola be cut at a plateau. Its hidden height is a third of its fall from the edge of the plateau to
    twice the distance from the middle. For a clipped peak, this height exceeds the step to the next lower level, and
    the noise.
    """
    top = lengths * (values[starts] == values.max())
    start, length = int(starts[np.argmax(top)]), int(top.max())
    if length < CLIPPED_RUN:
        return None
    aside = length // 2
    edges = [i for i in (start - aside, start + length - 1 + aside) if 0 <= i < len(values)]
    fall = float(np.mean(values.max() - values[edges])) if edges else 0.0
    step = float(values.max() - values[values < values.max()].max())
    return start if fall / 3 > CLIPPED_EDGE * max(step, _noise(values)) else None


def _noise(values: Float[np.ndarray, " time"]) -> float:
    """Standard deviation of white noise, from fourth differences, which a smooth signal hardly has."""
    from scipy.stats import median_abs_deviation  # takes half a second, and simulations import this module

    return float(median_abs_deviation(np.diff(values, 4), scale="normal") / np.sqrt(70)) if len(values) > 4 else 0.0
