"""Posteriors that a file has for every sample of a data set: of the oracles, of the twin, and of the floor."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from learn.inputs.inputs import OPERATING_POINT, SPECIMEN
from swgsim.oracle.columns import KNOWN
from swgsim.storage.labelled_signals import CLASSES

FACTS = ["row", *SPECIMEN, "severity", *OPERATING_POINT]
ORACLE, ORACLE_OF_SESSION = "oracle", "oracle that knows the session"
TWIN, FAST_TWIN, FLOOR = "twin on references", "fast twin on references", "floor of references"
# Methods of a file to the prefix of their columns. They take a unit as one long observation.
OF_ORACLE: Mapping[str, str] = {ORACLE: "", ORACLE_OF_SESSION: KNOWN}
OF_TWIN: Mapping[str, str] = {TWIN: "", FLOOR: "floor:", ORACLE: "oracle:", ORACLE_OF_SESSION: "oracle known:"}
OF_UNITS: Mapping[str, str] = {
    TWIN: "unit:",
    FLOOR: "floor unit:",
    ORACLE: "oracle unit:",
    ORACLE_OF_SESSION: "oracle known unit:",
}
# The twin that is given healthy specimens of the session as well, of recordings and of units.
OF_SESSION, UNITS_OF_SESSION = {TWIN: "session:"}, {TWIN: "session unit:"}


def posteriors(
    path: Path, digest: str, predictions: pd.DataFrame, prefixes: Mapping[str, str]
) -> dict[str, pd.DataFrame]:
    """Predictions from a file, on the recordings of some predictions.

    Parameters
    ----------
    path : Path
        ``<grid>-<condition>-oracle.parquet`` or ``-twin.parquet``.
    digest : str
        Digest of the data set.
    predictions : DataFrame
        Predictions of any method, for the judged rows and their facts.
    prefixes : mapping
        Name of a method to the prefix of its columns; methods that the file lacks are left out.

    Raises
    ------
    ValueError
        If the file is missing, belongs to another data set or lacks a judged gear, with the command that makes it.
    """
    grid, condition, command = path.stem.rsplit("-", 2)
    remedy = f"run 'swg {command} grid={grid} condition={condition}'"
    if not path.is_file():
        raise ValueError(f"no {command} {path}: {remedy}")
    table = pd.read_parquet(path)
    if table.attrs.get("data") != digest:
        raise ValueError(f"{path} belongs to another data set than the present {grid}-{condition}.h5: {remedy}")
    joined = predictions[FACTS].merge(table.drop(columns="severity", errors="ignore"), on="row", how="left")
    missing = joined[joined[CLASSES[0]].isna()]
    if len(missing):
        raise ValueError(f"{path} lacks gear {missing.iloc[0]['gear']}, which is judged: {remedy}")
    return {
        name: joined[FACTS].join(joined[columns].set_axis(list(CLASSES), axis="columns"))
        for name, prefix in prefixes.items()
        if set(columns := [prefix + label for label in CLASSES]) <= set(joined)
    }


def units_of(table: pd.DataFrame) -> pd.DataFrame:
    """One row per specimen of a table in which all recordings of a specimen have its posterior."""
    return table.drop_duplicates(list(SPECIMEN), ignore_index=True)


def mismatch(path: Path, judged: pd.DataFrame, digest: str) -> tuple[pd.DataFrame, pd.DataFrame] | None:
    """Predictions of recordings and of units by a twin, with the ``misfit`` of its gear; None without a file.

    Parameters
    ----------
    path : Path
        File of ``swg twin``, perhaps of other data or with mistaken beliefs.
    judged : DataFrame
        Predictions of any method. Of the data set with this digest, these recordings count, of others all.
    digest : str
    """
    if not path.is_file():
        return None
    table = pd.read_parquet(path)
    if table.attrs["data"] == digest:
        table = table[table["row"].isin(judged["row"])]
    facts = table.filter(like="true:").rename(columns=lambda name: name.removeprefix("true:"))
    facts["misfit"] = table["misfit"]
    recordings, units = (
        facts.join(table[[prefix + label for label in CLASSES]].set_axis(list(CLASSES), axis="columns"))
        for prefix in (OF_TWIN[TWIN], OF_UNITS[TWIN])
    )
    return recordings, units_of(units)
