"""Acquisition: an angle-triggered window at a fixed sampling rate, with optional white noise and quantisation."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.common.checks import require, require_integer, require_positive


@dataclass(frozen=True)
class Window:
    """The window of samples that starts when the wave generator passes its index.

    Attributes
    ----------
    rate : float
        Sampling rate [Hz].
    samples : int
        Number of samples; 600 at 10 kHz hold 2 revolutions at 2000 rpm and 4 at 4000 rpm.
    noise : float
        Standard deviation of white noise on every sample [mV/V].
    quantum : float
        Step of the converter [mV/V]; 0 for none.
    """

    rate: float = 10e3
    samples: int = 600
    noise: float = 0.0
    quantum: float = 0.0

    def __post_init__(self) -> None:
        require_positive("the window", rate=self.rate)
        require_integer("the window", "samples", self.samples, low=2, high=10_000_000)
        require("the window", "noise", self.noise, low=0, high=10)
        require("the window", "quantum", self.quantum, low=0, high=10)

    @property
    def time(self) -> Float[np.ndarray, " time"]:
        """Time of the samples [s]."""
        return np.arange(self.samples) / self.rate

    def acquire(
        self, signals: Float[np.ndarray, "sensor time"], rng: np.random.Generator
    ) -> Float[np.ndarray, "sensor time"]:
        """One recording's bridge signals [mV/V] as the converter delivers them."""
        if self.noise:
            signals = signals + rng.normal(0, self.noise, signals.shape)
        if self.quantum:
            signals = self.quantum * np.round(signals / self.quantum)
        return signals
