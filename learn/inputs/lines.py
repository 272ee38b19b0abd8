"""Order lines relative to the healthy gear, as a table of features."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Complex, Float

from learn.inputs.auxiliary_inputs import AuxiliaryInputs
from learn.inputs.inputs import LearningSet
from learn.inputs.residuals import ERRORS, HealthyLines, healthy_lines, require_acquisitions, residual
from swgsim.common.checks import require_integer
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals

Columns = dict[str, Float[np.ndarray, " sample"]]


@dataclass(frozen=True)
class ResidualLines:
    """Real and imaginary part of the residual lines of every gauge, with the auxiliary inputs.

    The residual is that of :func:`learn.inputs.residuals.residual`.

    Attributes
    ----------
    name : str
    orders : int
        Highest order of the wave generator's speed.
    efficiency, operating_point : bool
        As in :class:`learn.inputs.auxiliary_inputs.AuxiliaryInputs`.
    acquisitions : int or None
        Number of reference acquisitions to use at each operating point; None for all.

    Raises
    ------
    ValueError
        If a number is out of its limits.
    """

    name: str
    orders: int = 12
    efficiency: bool = True
    operating_point: bool = True
    acquisitions: int | None = None
    lowest_orders: ClassVar[int] = 1  # limit of `orders`

    def __post_init__(self) -> None:
        require_integer(self.name, "orders", self.orders, low=self.lowest_orders, high=1000)
        require_acquisitions(self.name, self.acquisitions)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Features of all samples."""
        healthy = healthy_lines(blocks, self.orders, self.acquisitions)
        lines, errors = residual(healthy)
        columns = self.line_columns(lines, healthy)
        columns |= AuxiliaryInputs(self.efficiency, self.operating_point).columns(healthy)
        columns |= dict(zip(ERRORS, errors.T, strict=True))
        return LearningSet(np.column_stack(list(columns.values())), healthy.table, tuple(columns))

    def line_columns(self, lines: Complex[np.ndarray, "sample sensor order"], healthy: HealthyLines) -> Columns:
        """Features of the residual lines [mV/V]."""
        columns: Columns = {}
        for sensor, name in enumerate(SENSORS):
            columns[f"{name}[0]"] = lines[:, sensor, 0].real
            for order in range(1, self.orders + 1):
                columns |= parts(f"{name}[{order}]", lines[:, sensor, order])
        return columns


def parts(name: str, line: Complex[np.ndarray, " sample"]) -> Columns:
    """Real and imaginary part under separate names."""
    return {f"Re {name}": line.real, f"Im {name}": line.imag}
