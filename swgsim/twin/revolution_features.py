"""Observations of simulated revolutions, as the oracle has them of recordings: the features of the fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.identification.data.features import Layout
from swgsim.oracle.model import ORDERS, observed
from swgsim.oracle.oracle import FEATURES
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS
from swgsim.storage.orders import order_lines


@dataclass(frozen=True)
class RevolutionFeatures(Layout):
    """Order lines over time, logarithm of the efficiency and temperature.

    Recordings of a data set have no angle, so their lines are over time, unlike those of the loop.

    Attributes
    ----------
    N : int
        Ratio of the gear, by which the efficiency follows from the torques.
    """

    channels: tuple[str, ...] = SENSORS
    N: int = 100

    def __len__(self) -> int:
        return FEATURES

    def of(self, recordings: Sequence[Recording]) -> Float[np.ndarray, "recording feature"]:
        """Observations of whole revolutions in the steady state, without errors of the bench."""
        found = np.empty((len(recordings), FEATURES))
        speeds = np.array([each.point.n_in_rpm for each in recordings])
        for speed in np.unique(speeds):
            rows = np.flatnonzero(speeds == speed)
            at_speed = [recordings[i] for i in rows]
            signals = np.array([[each.channels[name] for name in SENSORS] for each in at_speed])
            lines = order_lines(signals, float(speed), at_speed[0].rate, ORDERS)
            found[rows] = observed(
                lines,
                np.array([self._efficiency(each) for each in at_speed]),
                np.array([each.conditions.temperature for each in at_speed]),
            )
        return found

    def _efficiency(self, recording: Recording) -> float:
        """P_out / P_in: over whole revolutions the output turns N + 1 times slower than the input."""
        n_in, T_in, T_out = (recording.channels[name] for name in ("n_in", "T_in", "T_out"))
        return float(T_out.mean() * n_in.mean() / ((self.N + 1) * (T_in * n_in).mean()))
