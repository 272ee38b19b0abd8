"""Inputs of a network for any gear of a series: the residual of a recording, and the references of the same gear.

They are computed from rows of ``features=referenced``. References say how a fault would look on this gear, and how far
its healthy efficiency lies off the mean of its references, each of which has the bias of a session.
"""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float

from learn.inputs.auxiliary_inputs import AuxiliaryInputs
from learn.inputs.harmonics import RIPPLE_ORDERS, SMALLEST_RIPPLE, Harmonics
from learn.inputs.residuals import HealthyLines, residual
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint
from swgsim.oracle.model import ORDERS
from swgsim.oracle.oracle import EFFICIENCY, FEATURES, TEMPERATURE
from swgsim.storage.labelled_signals import SENSORS
from swgsim.storage.orders import whole_revolutions

# Columns of a row before its observation, and those of a reference before the mean observation.
POINT, BEFORE = 2, 3
# Orders that faults change under an elliptic wave generator, and the first one, of an eccentric one.
SHOWN = [1, *range(2, ORDERS + 1, 2)]
# Turns of a gear after which its gauges s1 to s4 stand where others stood.
QUARTERS = 4
# Lines of a torque ripple: of s0, and of the mean of the other gauges.
RIPPLES = (slice(0, 1), slice(1, None))


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

    def __call__(self, rows: Float[np.ndarray, "row column"], quarters: int = 0) -> Float[np.ndarray, "row input"]:
        """Inputs of rows of ``features=referenced``.

        Parameters
        ----------
        rows : array (row, column)
        quarters : int
            Turns by which the gear shall stand further (:func:`turned`); faults then have so much larger positions.

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
        lines, healthy = turned(lines, quarters), replace(healthy, reference=turned(healthy.reference, quarters))
        columns = Harmonics("").line_columns(lines, healthy) | AuxiliaryInputs().columns(healthy)
        ripples = [_ripple(lines[:, each].mean(axis=1), healthy.reference[:, each].mean(axis=1)) for each in RIPPLES]
        # In this form the friction of a gear is proportional to b1 at every operating point.
        loss = (np.exp(-said[:, :, EFFICIENCY]) - 1) * self._sorted[:, 1] / (self._sorted[:, 0] * np.pi / 30)
        of_gear = [_parts(healthy.reference), loss, np.nan_to_num(said[:, :, TEMPERATURE])]
        return np.column_stack([_parts(lines), *columns.values(), errors, *ripples, here, *of_gear])

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


def _parts(lines: Complex[np.ndarray, "row sensor order"]) -> Float[np.ndarray, "row part"]:
    """Means, and real and imaginary parts of the orders that show faults."""
    shown = lines[:, :, SHOWN]
    return np.concatenate([lines[:, :, :1].real, shown.real, shown.imag], axis=2).reshape(len(lines), -1)


def _ripple(
    line: Complex[np.ndarray, "row order"], healthy: Complex[np.ndarray, "row order"]
) -> Float[np.ndarray, "row input"]:
    """Change of a ripple along the healthy one, which a change of stiffness multiplies; and the size of the ripple."""
    line, healthy = line[:, RIPPLE_ORDERS], healthy[:, RIPPLE_ORDERS]
    size = np.maximum(np.abs(healthy), SMALLEST_RIPPLE)
    along, whole = line * healthy.conj(), np.sqrt((size**2).sum(axis=1, keepdims=True))
    change = along.real.sum(axis=1, keepdims=True)
    each = along / size
    return np.hstack([each.real, each.imag, change / whole, change / whole**2, np.log(size), np.log(whole)])


def turned(lines: Complex[np.ndarray, "row sensor order"], quarters: int) -> Complex[np.ndarray, "row sensor order"]:
    """Lines as if the gear with its fault, gauges and trigger stood some quarter turns further.

    The gauges s1 to s4 are a quarter turn apart. In a series no direction is preferred, so that these are lines of
    another gear of it. They must be free of errors of the speed, which leak into each other from the trigger on.
    """
    found = lines * (-1j) ** (quarters * np.arange(ORDERS + 1))
    return np.concatenate([found[:, :1], np.roll(found[:, 1:], quarters, axis=1)], axis=1)


def _lines(x: Float[np.ndarray, "*row feature"]) -> Complex[np.ndarray, "*row sensor order"]:
    """Order lines of observations [mV/V]."""
    means = len(SENSORS) * (ORDERS + 1)
    lines = x[..., :means].reshape(*x.shape[:-1], len(SENSORS), ORDERS + 1).astype(complex)
    lines[..., 1:] += 1j * x[..., means : FEATURES - 2].reshape(*x.shape[:-1], len(SENSORS), ORDERS)
    return lines
