"""The disturbance of eq. (10): an offset and sub-harmonics of the input speed, drawn for every gauge."""

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
        Upper limit of the uniform draws of a_1 to a_4 [mV/V]; the lower limit is 0.
    offset : float
        Limit of the uniform draw of a_0, of either sign [mV/V].

    Raises
    ------
    ValueError
        If an amplitude is not between 0 and 10 mV/V.
    """

    amplitude: float
    offset: float

    def __post_init__(self) -> None:
        require("the disturbance", "amplitude", self.amplitude, low=0, high=10)
        require("the disturbance", "offset", self.offset, low=0, high=10)

    def draw(
        self, rng: np.random.Generator, sensors: int, n_in_rpm: float, time: Float[np.ndarray, " time"]
    ) -> Float[np.ndarray, "sensor time"]:
        """Sum of eq. (10) that is added to the signals of one recording [mV/V].

        Parameters
        ----------
        rng : Generator
        sensors : int
        n_in_rpm : float
            Input speed [rpm].
        time : array (time,)
            [s].

        Returns
        -------
        array (sensor, time)
        """
        j = np.arange(1, 5)
        a_0 = rng.uniform(-self.offset, self.offset, (sensors, 1))
        a = rng.uniform(0, self.amplitude, (sensors, 4))
        alpha = rng.uniform(0, 2 * np.pi, (sensors, 4))
        angle = 2 * np.pi * n_in_rpm / 60 * time / j[:, None]
        # a sin(angle + alpha), split so that the angles are computed once for all sensors.
        return a_0 + (a * np.cos(alpha)) @ np.sin(angle) + (a * np.sin(alpha)) @ np.cos(angle)
