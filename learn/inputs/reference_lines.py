"""Inputs of a network that is told which gear it judges: the residual of a recording, and the references of its gear.

They are computed from rows of ``features=referenced``. References weigh little in themselves: they say how a fault of
this gear would look, and how far its healthy efficiency lies off the mean of the references.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float

from learn.inputs.auxiliary_inputs import AuxiliaryInputs
from learn.inputs.harmonics import Harmonics
from learn.inputs.lines import ResidualLines
from learn.inputs.residuals import HealthyLines, residual
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint
from swgsim.oracle.model import ORDERS
from swgsim.oracle.oracle import EFFICIENCY, FEATURES, TEMPERATURE
from swgsim.storage.labelled_signals import SENSORS
from swgsim.storage.orders import whole_revolutions

# Columns of a row before its observation, and those of a reference before the mean observation.
POINT, BEFORE = 2, 3


@dataclass(frozen=True)
class ReferenceLines:
    """Inputs for recordings of a window, with references at some operating points.

    Attributes
    ----------
    window : Window
        Of all recordings, which says how many revolutions each has.
    points : tuple of OperatingPoint
        At which every gear has references.
    """

    window: Window
    points: tuple[OperatingPoint, ...]

    def __call__(self, rows: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row input"]:
        """Inputs of rows of ``features=referenced``.

        Raises
        ------
        ValueError
            If the rows are others, references are at other operating points, or a recording is at none of them.
        """
        x, said = rows[:, POINT : POINT + FEATURES], self._references(rows)
        here = (said[:, :, :POINT] == rows[:, None, :POINT]).all(axis=2)
        if not here.any(axis=1).all():
            speed, load = rows[int(np.argmin(here.any(axis=1))), :POINT]
            raise ValueError(f"no reference at {speed:g} rpm and {load:g} N m: record the healthy gear there")
        healthy = self._healthy(rows[:, :POINT], x, said, here.argmax(axis=1))
        lines, errors = residual(healthy)
        columns = ResidualLines("").line_columns(lines, healthy) | Harmonics("").line_columns(lines, healthy)
        columns |= AuxiliaryInputs().columns(healthy)
        of_gear = ResidualLines("").line_columns(healthy.reference, healthy).values()
        levels = said[:, :, [EFFICIENCY, TEMPERATURE]].reshape(len(rows), -1)
        return np.column_stack([*columns.values(), errors, here, *of_gear, levels])

    def _healthy(
        self,
        point: Float[np.ndarray, "row 2"],
        x: Float[np.ndarray, "row feature"],
        said: Float[np.ndarray, "row point column"],
        here: np.ndarray,
    ) -> HealthyLines:
        """Lines of the recordings beside those of the references at their operating points."""
        lines, points = _lines(said[:, :, BEFORE:]), self._sorted
        slope = np.zeros_like(lines)
        for speed in np.unique(points[:, 0]):
            at = np.flatnonzero(points[:, 0] == speed)
            at = at[np.argsort(points[at, 1])]
            if len(at) > 1:
                slope[:, at] = np.gradient(lines[:, at], points[at, 1], axis=1)
        length, rate = self.window.samples, self.window.rate
        turns = {
            speed: round(whole_revolutions(speed, rate, length) * speed / 60 / rate) for speed in points[:, 0].tolist()
        }
        facts = {"efficiency": np.exp(x[:, EFFICIENCY]), "temperature_c": x[:, TEMPERATURE]}
        table = pd.DataFrame({"n_in_rpm": point[:, 0], "T_out_nm": point[:, 1], **facts})
        own = np.arange(len(x)), here
        return HealthyLines(
            table, _lines(x), lines[own], slope[own], np.array([turns[speed] for speed in point[:, 0]]),
            np.exp(said[:, :, EFFICIENCY][own]), said[:, :, TEMPERATURE][own],
        )  # fmt: skip

    def _references(self, rows: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row point column"]:
        """What a row says of each operating point: speed, load, number and mean observation of its references."""
        said = rows[:, POINT + FEATURES :]
        if not said.shape[1] or said.shape[1] % (BEFORE + FEATURES):
            raise ValueError(f"{rows.shape[1]} columns are no rows with references: choose features=referenced")
        said = said.reshape(len(rows), -1, BEFORE + FEATURES)
        if said.shape[1] != len(self.points) or (said[:, :, :POINT] != self._sorted).any():
            known = ", ".join(f"[{speed:g}, {load:g}]" for speed, load in self._sorted)
            raise ValueError(
                f"the network was trained for the operating points {known} [rpm, N m], and these references are at "
                "others: train it for the grid of the recordings, or take classifier=twin"
            )
        return said

    @property
    def _sorted(self) -> Float[np.ndarray, "point 2"]:
        """Speed [rpm] and load [N m] of the operating points, in the order of the rows."""
        return np.array(sorted((point.n_in_rpm, point.T_out) for point in self.points))


def _lines(x: Float[np.ndarray, "*row feature"]) -> Complex[np.ndarray, "*row sensor order"]:
    """Order lines of observations [mV/V]."""
    means = len(SENSORS) * (ORDERS + 1)
    lines = x[..., :means].reshape(*x.shape[:-1], len(SENSORS), ORDERS + 1).astype(complex)
    lines[..., 1:] += 1j * x[..., means : FEATURES - 2].reshape(*x.shape[:-1], len(SENSORS), ORDERS)
    return lines
