"""The features of an exported method: their C files, macros and healthy numbers."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float

from learn.embedded.source import Macros, values
from learn.inputs.features import Selection, signal_quantities
from learn.inputs.harmonics import RIPPLE_ORDERS, SMALLEST_RIPPLE, WAVE_NUMBERS, Harmonics
from learn.inputs.inputs import Representation
from learn.inputs.references import HEALTHY, healthy_reference
from learn.inputs.residuals import BENCH, ERRORS, healthy_lines, leakage
from learn.inputs.signals import Signals
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals

COMMON = ("swg.h", "window.c", "decide.c", "lines.h", "lines.c")


class Healthy(NamedTuple):
    """Healthy values for the features at each operating point, in the order of :func:`operating_points`.

    Order lines [mV/V], array (point, sensor, order), which may be empty (point, 0, 0); and other numbers.
    """

    lines: Complex[np.ndarray, "point sensor order"]
    numbers: Float[np.ndarray, "point number"]


@dataclass(frozen=True)
class Front:
    """How features are made on the microcontroller.

    Attributes
    ----------
    files : tuple of str
        Names of the C files, of :mod:`learn.embedded`'s folder ``c``.
    sizes : Macros
        Their macros.
    orders : int
        Highest order whose lines are taken.
    healthy : callable
        Healthy values for the features from the healthy recordings of a gear.
    """

    files: tuple[str, ...]
    sizes: Macros
    orders: int
    healthy: Callable[[LabelledSignals], Healthy]


def front(representation: Representation) -> Front:
    """The front end that makes the features of a representation.

    Raises
    ------
    ValueError
        If there is no C code for this representation, or for so many points.
    """
    if isinstance(representation, Selection):
        return _selection(representation)
    if isinstance(representation, Harmonics):
        columns = len(SENSORS) + len(WAVE_NUMBERS) * (representation.orders // 2 + 1) + 6 * len(RIPPLE_ORDERS)
        ripple = values(np.array(RIPPLE_ORDERS))
        own: Macros = {"RIPPLE_ORDERS": ripple, "SMALLEST_RIPPLE": SMALLEST_RIPPLE}
        return _of_residual(representation, "harmonics.c", columns, own)
    if isinstance(representation, Signals) and representation.name == "residual":
        points = representation.points
        if points % 4:
            raise ValueError(f"signals of {points} points have no front end in C: take a multiple of 4")
        cosines = values(np.cos(2 * np.pi * np.arange(points) / points)).replace("\n", "\\\n")
        return _of_residual(representation, "signal.c", len(SENSORS) * points, {"POINTS": points, "COSINES": cosines})
    name = getattr(representation, "name", type(representation).__name__)
    raise ValueError(
        f"features={name} have no front end in C: take selection_1, selection_2, selection_3, harmonics or residual"
    )


def operating_points(references: LabelledSignals) -> pd.DataFrame:
    """One row of facts for each operating point of a gear's healthy recordings, by speed and load."""
    return references.table.drop_duplicates(HEALTHY).sort_values(HEALTHY)


def _selection(selection: Selection) -> Front:
    if not selection.whole_revolutions:
        raise ValueError(
            f"features={selection.name} over broken revolutions have no front end in C: take whole_revolutions=true"
        )
    orders = selection.orders if selection.spectrum != "none" else 0
    sizes: Macros = {
        "ORDERS": orders,
        "COLUMNS": len(selection.names),
        "FLOOR": float(selection.floor),
        "STATISTICS": int(selection.statistics),
        "GAUGE_SPECTRUM": int(selection.spectrum in ("gauges", "both")),
        "DIFFERENCE_SPECTRUM": int(selection.spectrum in ("differences", "both")),
        "EFFICIENCY": int(selection.efficiency in ("eta_rel", "both")),
        "ROOT_OF_EFFICIENCY": int(selection.efficiency in ("eta2_rel", "both")),
        "OPERATING_POINT": int(selection.operating_point),
    }

    def healthy(references: LabelledSignals) -> Healthy:
        quantities = signal_quantities(references, selection)
        numbers = healthy_reference(quantities, references.table, operating_points(references))
        return Healthy(np.empty((len(numbers), 0, 0), complex), numbers)

    return Front((*COMMON, "selection.c"), sizes, orders, healthy)


def _of_residual(representation: Harmonics | Signals, file: str, columns: int, own: Macros) -> Front:
    """Columns from the residual lines, auxiliary columns, and the errors that were removed."""
    orders, acquisitions = representation.orders, representation.acquisitions
    sizes: Macros = {
        "ORDERS": orders,
        "COLUMNS": columns + 3 * representation.efficiency + 3 * representation.operating_point + len(ERRORS),
        "LIKELY_LOAD": BENCH.load,
        "LIKELY_ANGLE": BENCH.angle,
        "LIKELY_SPEED": BENCH.speed,
        "LIKELY_LINE": BENCH.line,
        "EFFICIENCY": int(representation.efficiency),
        "OPERATING_POINT": int(representation.operating_point),
        **own,
    }
    files = (*COMMON, "residual.h", "residual.c", file)
    return Front(files, sizes, orders, lambda references: _healthy_lines(references, orders, acquisitions))


def _healthy_lines(references: LabelledSignals, orders: int, acquisitions: int | None) -> Healthy:
    """The healthy lines and their change with each error, of :func:`learn.inputs.residuals.residual`."""
    rows = references.table.index.get_indexer(operating_points(references).index)
    samples = references.where(rows)  # one recording of each point as a sample, to get its healthy lines
    samples = replace(samples, table=samples.table.assign(reference=False))
    healthy = healthy_lines([references, samples], orders, acquisitions)
    lines = healthy.reference
    turned = 1j * np.arange(orders + 1) * lines
    changes = np.stack([healthy.slope, turned, leakage(lines, healthy.revolutions)], axis=1)
    return Healthy(lines, np.stack([changes.real, changes.imag], axis=-1).reshape(len(rows), -1))
