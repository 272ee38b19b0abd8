"""Order lines relative to the healthy gear, as a table of features."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from learn.inputs.auxiliary_inputs import Side
from learn.inputs.inputs import LearningSet
from learn.inputs.residuals import ERRORS, healthy_lines, require_acquisitions, residual
from swgsim.common.checks import require_integer
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals


@dataclass(frozen=True)
class ResidualLines:
    """Real and imaginary part of every gauge's residual (:func:`residuals.residual`), with the side inputs.

    Attributes
    ----------
    name : str
    orders : int
        Highest order of the wave generator's speed.
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
        require_integer(self.name, "orders", self.orders, low=1, high=1000)
        require_acquisitions(self.name, self.acquisitions)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """The features of all samples."""
        healthy = healthy_lines(blocks, self.orders, self.acquisitions)
        lines, errors = residual(healthy)
        columns: dict[str, np.ndarray] = {}
        for sensor, name in enumerate(SENSORS):
            columns[f"{name}[0]"] = lines[:, sensor, 0].real
            for order in range(1, self.orders + 1):
                columns |= parts(f"{name}[{order}]", lines[:, sensor, order])
        columns |= Side(self.efficiency, self.operating_point).columns(healthy)
        columns |= dict(zip(ERRORS, errors.T, strict=True))
        return LearningSet(np.column_stack(list(columns.values())), healthy.table, tuple(columns))


def parts(name: str, line: Complex[np.ndarray, " sample"]) -> dict[str, Float[np.ndarray, " sample"]]:
    """Real and imaginary part under names of their own."""
    return {f"Re {name}": line.real, f"Im {name}": line.imag}
