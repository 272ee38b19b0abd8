"""Features that follow from the symmetries of the gear and do not depend on the place of a fault.

A crack at another angle turns its signature around the flex spline. Take the four gauges as a Fourier series around the
circumference, and their lines over the angle of the wave generator: magnitudes stay, only phases change.

Stiffness multiplies the torque ripple by a factor that does not depend on the gear's own kinematic error. The ripple is
therefore divided by the healthy one.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Complex

from learn.inputs.lines import Columns, ResidualLines, parts
from learn.inputs.residuals import HealthyLines
from swgsim.storage.labelled_signals import SENSORS

RIPPLE_ORDERS = (1, 2, 4)  # of the kinematic error (eq. 2)
SMALLEST_RIPPLE = 2e-4  # mV/V; the noise of condition=bench leaves a fifth of it on a line
WAVE_NUMBERS = (0, 1, 2, 3)  # that four gauges can distinguish


@dataclass(frozen=True)
class Harmonics(ResidualLines):
    """Features of the residual lines that do not depend on the angle of a fault, with the auxiliary inputs.

    They are: magnitudes of s1 to s4 by even order over the angle and wave number around the circumference; offsets of
    the five gauges; torque ripple (s0, and the mean of s1 to s4), absolute and divided by the healthy one. Odd orders
    are left out, because no fault shows there under an elliptic wave generator (docs/chain.md). The attributes are
    those of :class:`learn.inputs.lines.ResidualLines`.
    """

    lowest_orders: ClassVar[int] = max(RIPPLE_ORDERS)

    def line_columns(self, lines: Complex[np.ndarray, "sample sensor order"], healthy: HealthyLines) -> Columns:
        """Features of the residual lines [mV/V, and - for ratios]."""
        around = np.fft.fft(lines[:, 1:], axis=1) / 4  # (sample, wave number, order)
        columns = {f"{sensor}[0]": lines[:, i, 0].real for i, sensor in enumerate(SENSORS)}
        for order in range(0, self.orders + 1, 2):
            for wave_number in WAVE_NUMBERS:
                columns[f"|s1..s4[{order}]| wave {wave_number}"] = np.abs(around[:, wave_number, order])
        for order in RIPPLE_ORDERS:
            relative = 1 / _bounded_below(healthy.reference[:, 0, order])
            columns |= parts(f"s0[{order}]", lines[:, 0, order])
            columns |= parts(f"s0[{order}] / healthy", lines[:, 0, order] * relative)
            columns |= parts(f"mean[{order}] / healthy", around[:, 0, order] * relative)
        return columns


def _bounded_below(line: Complex[np.ndarray, " sample"]) -> Complex[np.ndarray, " sample"]:
    """The line with a magnitude of at least SMALLEST_RIPPLE."""
    size = np.abs(line)
    return np.where(size > 0, line / np.where(size > 0, size, 1), 1) * np.maximum(size, SMALLEST_RIPPLE)
