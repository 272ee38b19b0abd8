"""Signals as inputs: one revolution of the gauges, raw, differenced or relative to the healthy gear."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from learn.inputs.auxiliary_inputs import AuxiliaryInputs
from learn.inputs.inputs import Layout, LearningSet
from learn.inputs.residuals import ERRORS, healthy_lines, require_acquisitions, residual
from swgsim.common.checks import require_integer, require_known
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals
from swgsim.storage.orders import revolution

WITH_REFERENCE = "residual_with_reference"
CHANNELS = {
    "raw": SENSORS,
    "template": SENSORS,
    "differenced": ("ds13", "ds24"),
    "residual": SENSORS,
    WITH_REFERENCE: (*SENSORS, *(f"healthy {sensor}" for sensor in SENSORS)),
}
RESIDUAL = ("residual", WITH_REFERENCE)
RELATIVE = ("template", *RESIDUAL)  # to the healthy reference


@dataclass(frozen=True)
class Signals:
    """Signal over one revolution of the wave generator, the mean over all revolutions of the window.

    Attributes
    ----------
    name : {"raw", "template", "differenced", "residual", "residual_with_reference"}
        Five gauges; the five gauges minus the healthy reference at the operating point; the gauge differences of
        eq. (8); the residual of the five gauges (:func:`learn.inputs.residuals.residual`); or this residual and the
        healthy reference of the five gauges without its mean over the revolution (order 0). The reference shows
        parameters of the gear that the residual lacks. Its mean shows the load instead, and a zero.
    points : int
        Number of angles.
    orders : int
        Highest order of the signal.
    efficiency, operating_point, reference : bool
        As in :class:`learn.inputs.auxiliary_inputs.AuxiliaryInputs`.
    acquisitions : int or None
        Number of reference acquisitions to use at each operating point; None for all.

    Raises
    ------
    ValueError
        If a value is not one of the choices or out of its limits, or the residual has no reference.
    """

    name: str
    points: int = 64
    orders: int = 24
    efficiency: bool = True
    operating_point: bool = True
    reference: bool = True
    acquisitions: int | None = None

    def __post_init__(self) -> None:
        require_known("the signals", [self.name], CHANNELS)
        if self.name in RELATIVE and not self.reference:
            raise ValueError(
                f"features={self.name} is relative to a healthy reference: reference=true, or features=raw"
            )
        require_integer(self.name, "points", self.points, low=8, high=4096)
        require_integer(self.name, "orders", self.orders, low=1, high=self.points // 2 - 1)
        require_acquisitions(self.name, self.acquisitions)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Signals of all samples, followed by the auxiliary inputs."""
        healthy = healthy_lines(blocks, self.orders, self.acquisitions)
        auxiliary = AuxiliaryInputs(self.efficiency, self.operating_point, self.reference).columns(healthy)
        lines = healthy.lines
        if self.name == "differenced":
            lines = lines[:, 1:3] - lines[:, 3:5]  # eq. 8
        elif self.name == "template":
            lines = lines - healthy.reference
        elif self.name in RESIDUAL:
            lines, errors = residual(healthy)
            auxiliary |= dict(zip(ERRORS, errors.T, strict=True))
        if self.name == WITH_REFERENCE:
            # One scale holds for a whole channel. With the mean, which the load changes most, it would be more than ten
            # times as large and hide the differences between gears.
            lines = np.concatenate([lines, np.where(np.arange(self.orders + 1), healthy.reference, 0)], axis=1)
        signal = revolution(lines, self.points)
        names = [f"{channel}({point}/{self.points})" for channel in CHANNELS[self.name] for point in range(self.points)]
        features = np.column_stack([signal.reshape(len(signal), -1), *auxiliary.values()])
        return LearningSet(features, healthy.table, (*names, *auxiliary), Layout(signal.shape[1], self.points))
