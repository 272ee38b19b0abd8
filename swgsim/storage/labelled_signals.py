"""Labelled gauge signals, simulated or measured, with a table of one row per recording."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from swgsim.common.checks import require_known

CLASSES = (
    "healthy",
    "reduced_damping",
    "reduced_stiffness",
    "eccentric_wave_generator",
    "root_tooth_crack",
    "tip_tooth_crack",
)
SENSORS = ("s0", "s1", "s2", "s3", "s4")


@dataclass(frozen=True)
class Column:
    """One column of the table: type on disk, unit and description."""

    dtype: str
    units: str
    long_name: str


COLUMNS: Mapping[str, Column] = {
    "gear": Column("i4", "1", "number of the gear, from 1"),
    "label": Column("i1", "1", "condition of the gear"),
    "variant": Column("i4", "1", "number of the variant of the condition, from 0"),
    "severity": Column("f8", "see label", "physical size of the fault, in the unit of its effect; NaN when healthy"),
    "position": Column("f8", "rad", "angle of the fault around the flex spline; NaN where it has none"),
    "n_in_rpm": Column("f8", "rpm", "desired speed of the wave generator"),
    "T_out_nm": Column("f8", "N m", "desired load torque at the output"),
    "efficiency": Column("f8", "1", "P_out / P_in over whole revolutions of the wave generator, as recorded"),
    "temperature_c": Column("f8", "degC", "temperature of the gear, as recorded; NaN where it is not"),
    "reference": Column("i1", "1", "1 for a separate healthy acquisition that serves as the gear's reference"),
    "seed": Column("u8", "1", "seed of every random draw of this recording"),
}


@dataclass(frozen=True)
class LabelledSignals:
    """Gauge signals with labels and conditions.

    Attributes
    ----------
    signals : array (sample, sensor, time), float32
        Bridge signals s0 to s4 [mV/V].
    table : DataFrame
        One row per sample with the columns of :data:`COLUMNS`; ``label`` is categorical over :data:`CLASSES`,
        ``reference`` is boolean.
    rate : float
        Sampling rate [Hz].
    attributes : mapping
        Texts of the whole set: version, configuration.

    Raises
    ------
    ValueError
        If table and signals disagree or a signal is not finite; the message names sample, sensor and value.
    """

    signals: Float[np.ndarray, "sample sensor time"]
    table: pd.DataFrame
    rate: float
    attributes: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if len(self.table) != len(self.signals):
            raise ValueError(f"{len(self.signals)} recordings but {len(self.table)} rows in the table: one row each")
        if list(self.table.columns) != list(COLUMNS):
            raise ValueError(f"columns {list(self.table.columns)} found, expected {list(COLUMNS)}")
        if self.signals.shape[1] != len(SENSORS):
            raise ValueError(f"{self.signals.shape[1]} sensors found, expected {len(SENSORS)}: {SENSORS}")
        if not 0 < self.rate < float("inf"):
            raise ValueError(f"sampling rate {self.rate} Hz must be a finite number above 0")
        bad = np.argwhere(~np.isfinite(self.signals))
        if len(bad):
            sample, sensor, time = bad[0]
            raise ValueError(
                f"recording {sample}, {SENSORS[sensor]}, sample {time}: found {self.signals[sample, sensor, time]}, "
                "expected a finite number"
            )

    def __len__(self) -> int:
        return len(self.signals)

    def where(self, rows: np.ndarray | pd.Series) -> "LabelledSignals":
        """The recordings of a boolean mask or of a list of row numbers."""
        rows = np.asarray(rows)
        rows = np.flatnonzero(rows) if rows.dtype == bool else rows
        return replace(self, signals=self.signals[rows], table=self.table.iloc[rows].reset_index(drop=True))

    @property
    def samples(self) -> "LabelledSignals":
        """The recordings to classify: all but the references."""
        return self.where(~self.table["reference"])

    @property
    def references(self) -> "LabelledSignals":
        """The reference recordings of each gear."""
        return self.where(self.table["reference"])


def facts(rows: Mapping[str, object]) -> pd.DataFrame:
    """A table with the columns, order and types of :data:`COLUMNS`.

    Parameters
    ----------
    rows : mapping
        Column name to values, one per recording; ``label`` holds class names.

    Raises
    ------
    ValueError
        If a column is missing or unknown, or a label is not one of :data:`CLASSES`.
    """
    table = pd.DataFrame(rows)
    if set(table.columns) != set(COLUMNS):
        raise ValueError(f"columns {sorted(table.columns)} found, expected {sorted(COLUMNS)}")
    require_known("label", table["label"].unique(), CLASSES)
    table = table[list(COLUMNS)].astype({n: c.dtype for n, c in COLUMNS.items() if n != "label"})
    table["label"] = pd.Categorical(table["label"], categories=list(CLASSES))
    table["reference"] = table["reference"].astype(bool)
    return table
