"""Features that follow from the symmetries of the gear: what a fault changes, wherever it sits.

A crack at another angle turns its signature around the flex spline: the four gauges, as a Fourier series around the
circumference, and their orders over the wave generator's angle keep their magnitudes and change phases only. And
stiffness changes the torque ripple by a factor that does not depend on the size and phase of a gear's own kinematic
error, so the ripple is set in relation to the healthy one.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex

from learn.inputs.auxiliary_inputs import Side
from learn.inputs.inputs import LearningSet
from learn.inputs.lines import parts
from learn.inputs.residuals import ERRORS, healthy_lines, require_acquisitions, residual
from swgsim.common.checks import require_integer
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals

RIPPLE_ORDERS = (1, 2, 4)  # of the kinematic error (eq. 2)
SMALLEST_RIPPLE = 2e-4  # mV/V; the noise of condition=bench leaves a fifth of it on a line
WAVE_NUMBERS = (0, 1, 2, 3)  # that four gauges can tell apart


@dataclass(frozen=True)
class Harmonics:
    """Invariants of the residual to the healthy gear (:func:`learn.inputs.residuals.residual`), with the side inputs.

    Magnitudes of the gauges s1 to s4 by even order over the angle and wave number around the circumference; offsets of
    the five gauges; torque ripple (s0, and the mean of s1 to s4) as it is and in relation to the healthy one.

    Attributes
    ----------
    name : str
    orders : int
        Highest order of the wave generator's speed. Odd orders are left out: under an elliptic wave generator no fault
        shows there (docs/chain.md).
    efficiency, operating_point : bool
        As in :class:`learn.inputs.auxiliary_inputs.Side`.
    acquisitions : int or None
        Reference acquisitions to use at each operating point; None for all.
    """

    name: str
    orders: int = 12
    efficiency: bool = True
    operating_point: bool = True
    acquisitions: int | None = None

    def __post_init__(self) -> None:
        require_integer(self.name, "orders", self.orders, low=max(RIPPLE_ORDERS), high=1000)
        require_acquisitions(self.name, self.acquisitions)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """The features of all samples."""
        healthy = healthy_lines(blocks, self.orders, self.acquisitions)
        lines, errors = residual(healthy)
        around = np.fft.fft(lines[:, 1:], axis=1) / 4  # (sample, wave number, order)
        columns = {f"{sensor}[0]": lines[:, i, 0].real for i, sensor in enumerate(SENSORS)}
        for order in range(0, self.orders + 1, 2):
            for wave_number in WAVE_NUMBERS:
                columns[f"|s1..s4[{order}]| wave {wave_number}"] = np.abs(around[:, wave_number, order])
        for order in RIPPLE_ORDERS:
            relative = 1 / _kept_from_vanishing(healthy.reference[:, 0, order])
            columns |= parts(f"s0[{order}]", lines[:, 0, order])
            columns |= parts(f"s0[{order}] / healthy", lines[:, 0, order] * relative)
            columns |= parts(f"mean[{order}] / healthy", around[:, 0, order] * relative)
        columns |= Side(self.efficiency, self.operating_point).columns(healthy)
        columns |= dict(zip(ERRORS, errors.T, strict=True))
        return LearningSet(np.column_stack(list(columns.values())), healthy.table, tuple(columns))


def _kept_from_vanishing(line: Complex[np.ndarray, " sample"]) -> Complex[np.ndarray, " sample"]:
    size = np.abs(line)
    return np.where(size > 0, line / np.where(size > 0, size, 1), 1) * np.maximum(size, SMALLEST_RIPPLE)
