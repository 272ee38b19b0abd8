"""The disturbance of eq. (10): an offset and sub-harmonics of the input speed, drawn anew for every sensor."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.common.checks import require


@dataclass(frozen=True)
class Disturbance:
    """Amplitudes of eq. (10).

    Attributes
    ----------
    amplitude : float
        a_j is drawn evenly from 0 to this [mV/V], for j = 1 to 4.
    offset : float
        a_0 is drawn evenly from minus to plus this [mV/V].
    """

    amplitude: float
    offset: float

    def __post_init__(self) -> None:
        require("the disturbance", "amplitude", self.amplitude, low=0, high=10)
        require("the disturbance", "offset", self.offset, low=0, high=10)

    def draw(
        self, rng: np.random.Generator, sensors: int, n_in_rpm: float, time: Float[np.ndarray, " time"]
    ) -> Float[np.ndarray, "sensor time"]:
        """What eq. (10) adds to the signals of one recording [mV/V].

        Parameters
        ----------
        rng : Generator
        sensors : int
        n_in_rpm : float
            Input speed [rpm].
        time : array (time,)
            [s].
        """
        j = np.arange(1, 5)
        a_0 = rng.uniform(-self.offset, self.offset, (sensors, 1))
        a = rng.uniform(0, self.amplitude, (sensors, 4))
        alpha = rng.uniform(0, 2 * np.pi, (sensors, 4))
        angle = 2 * np.pi * n_in_rpm / 60 * time / j[:, None]
        # a sin(angle + alpha), split so that the angles are computed once for all sensors.
        return a_0 + (a * np.cos(alpha)) @ np.sin(angle) + (a * np.sin(alpha)) @ np.cos(angle)
