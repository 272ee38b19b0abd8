"""Labelled signals on disk: one HDF5 file in the layout of NetCDF-4, which xarray opens, sealed by a SHA-256.

The first 512 bytes (the HDF5 user block) hold the SHA-256 of the rest; every read checks it.

>>> data = xarray.open_dataset("data/paper-clean.h5", engine="h5netcdf")  # doctest: +SKIP
>>> cracked = data.where(data.label_name == "root_tooth_crack", drop=True)  # doctest: +SKIP
"""

import hashlib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from swgsim.common.files import replacing
from swgsim.storage.attributes import attribute, set_attributes
from swgsim.storage.hdf5_reader import opened
from swgsim.storage.hdf5_writer import created
from swgsim.storage.labelled_signals import CLASSES, COLUMNS, SENSORS, LabelledSignals

SEAL_SIZE = 512
# What a sealed file holds, and what to do where it is damaged.
RECORDINGS, AGAIN = "recordings", "generate it again"


def seal_start(what: str) -> bytes:
    """The first bytes of a sealed file.

    >>> seal_start("unit")
    b'swgsim unit, sha256 '
    """
    return f"swgsim {what}, sha256 ".encode()


SEAL_START = seal_start(RECORDINGS)


def write(path: Path, blocks: Iterable[LabelledSignals], rows: int) -> None:
    """Write recordings block by block; the file is complete or absent.

    Parameters
    ----------
    path : Path
    blocks : iterable of LabelledSignals
        With the same rate and window; the attributes of the first are written.
    rows : int
        Number of recordings in all blocks together.

    Raises
    ------
    ValueError
        If the blocks do not have ``rows`` recordings together.
    OSError
        If the disk is full or the folder cannot be written; the message names the remedy.
    """
    with replacing(path) as aside:
        with created(aside, SEAL_SIZE) as (file, raw):
            done = 0
            for block in blocks:
                if not done:
                    _lay_out(file, block, rows)
                if done + len(block) > rows:
                    raise ValueError(f"{path}: more than the {rows} recordings announced")
                where = slice(done, done + len(block))
                file["signals"][where] = block.signals
                for name in COLUMNS:
                    values = block.table[name].cat.codes if name == "label" else block.table[name]
                    file[name][where] = values.to_numpy()
                file["label_name"][where] = block.table["label"].to_numpy().astype("S")
                raw.require_written()
                done += len(block)
        if done != rows:
            raise ValueError(f"{path}: {done} recordings found, {rows} announced")
        seal(aside)


def _lay_out(file: h5py.File, first: LabelledSignals, rows: int) -> None:
    """Create all variables with their dimensions, units and descriptions."""
    samples = first.signals.shape[2]
    set_attributes(file, **{"Conventions": "CF-1.11", "title": "strain wave gear gauge signals", **first.attributes})
    set_attributes(file, sampling_rate_hz=first.rate)
    coordinates = {
        "sample": (np.arange(rows), "1", "number of the recording"),
        "sensor": (np.array(SENSORS, dtype="S"), "1", "strain-gauge bridge"),
        "time": (np.arange(samples) / first.rate, "s", "time since the trigger"),
    }
    for name, (values, units, long_name) in coordinates.items():
        variable = file.create_dataset(name, data=values)
        variable.make_scale(name)
        set_attributes(variable, units=units, long_name=long_name)
    shape, dimensions = (rows, len(SENSORS), samples), ("sample", "sensor", "time")
    signals = file.create_dataset("signals", shape, "f4", chunks=(1, *shape[1:]), fletcher32=True)
    set_attributes(signals, units="mV/V", long_name="bridge signal")
    variables: list[tuple[h5py.Dataset, tuple[str, ...]]] = [(signals, dimensions)]
    for name, column in COLUMNS.items():
        variable = file.create_dataset(name, (rows,), column.dtype, chunks=(min(rows, 4096),), fletcher32=True)
        set_attributes(variable, units=column.units, long_name=column.long_name)
        variables.append((variable, ("sample",)))
    names = file.create_dataset("label_name", (rows,), f"S{max(map(len, CLASSES))}", chunks=(min(rows, 4096),))
    set_attributes(names, units="1", long_name="condition of the gear as text; label has it as a number")
    variables.append((names, ("sample",)))
    set_attributes(file["label"], flag_values=np.arange(len(CLASSES), dtype="i1"), flag_meanings=" ".join(CLASSES))
    for text in (file["sensor"], names):
        set_attributes(text, _Encoding="utf-8")  # so that xarray gives text
    for variable, axes in variables:
        for axis, name in enumerate(axes):
            variable.dims[axis].attach_scale(file[name])


def seal(path: Path, what: str = RECORDINGS) -> None:
    """Write what a file holds, and the SHA-256 of the rest, into its first bytes, which HDF5 leaves free."""
    with path.open("r+b") as raw:
        raw.seek(SEAL_SIZE)
        digest = hashlib.file_digest(raw, "sha256").hexdigest()
        raw.seek(0)
        raw.write((seal_start(what) + digest.encode() + b"\n").ljust(SEAL_SIZE))


def is_sealed(path: Path, what: str) -> bool:
    """Whether a path is a file that begins with a seal of what it should hold."""
    if not path.is_file():
        return False
    with path.open("rb") as raw:
        return raw.read(SEAL_SIZE).startswith(seal_start(what))


def digest(path: Path, what: str = RECORDINGS, again: str = AGAIN) -> str:
    """The SHA-256 in the seal of a file.

    Parameters
    ----------
    path : Path
    what : str
        What the file should hold.
    again : str
        What to do where it does not, for the message.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is not a sealed file of that.
    """
    with path.open("rb") as raw:
        start = raw.read(SEAL_SIZE)
    found = re.fullmatch(re.escape(seal_start(what)) + rb"([0-9a-f]{64})\n *", start)
    if not found or len(start) < SEAL_SIZE:
        raise ValueError(f"{path}: not a file of {what} (its first {SEAL_SIZE} bytes are no seal); {again}")
    return found[1].decode()


def verify(path: Path, what: str = RECORDINGS, again: str = AGAIN) -> None:
    """Raise a ValueError with the name of the file unless its content has the SHA-256 of its seal.

    Parameters are those of :func:`digest`.
    """
    expected = digest(path, what, again)
    with path.open("rb") as raw:
        raw.seek(SEAL_SIZE)
        found = hashlib.file_digest(raw, "sha256").hexdigest()
    if found != expected:
        raise ValueError(
            f"{path}: damaged or truncated, SHA-256 found {found[:12]}…, expected {expected[:12]}…; {again}"
        )


def read(path: Path) -> LabelledSignals:
    """All recordings of a file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is damaged or not a file of recordings; the message names it.
    """
    return next(blocks(path))


def blocks(path: Path, rows: int | None = None) -> Iterator[LabelledSignals]:
    """The recordings of a file in blocks of ``rows`` (by default one block); the seal is checked first."""
    verify(path)
    texts = attributes(path)
    with _opened(path) as file:
        _require_layout(path, file)
        rate = float(attribute(file, "sampling_rate_hz"))
        total = len(file["signals"])
        for start in range(0, total, rows or total):
            where = slice(start, start + (rows or total))
            columns = {name: file[name][where] for name in COLUMNS}
            if not np.isin(columns["label"], range(len(CLASSES))).all():
                raise ValueError(f"label is not from 0 to {len(CLASSES) - 1} in recordings from {start}")
            columns["label"] = pd.Categorical.from_codes(columns["label"], categories=pd.Index(CLASSES))
            columns["reference"] = columns["reference"].astype(bool)
            yield LabelledSignals(file["signals"][where], pd.DataFrame(columns), rate, texts)


def attributes(path: Path) -> dict[str, str]:
    """Text attributes of a file, such as configuration and version of the code."""
    with _opened(path) as file:
        values = {name: attribute(file, name) for name in file.attrs}
    return {name: value for name, value in values.items() if isinstance(value, str)}


def shape(path: Path) -> tuple[int, int, int]:
    """Number of recordings in a file, of their sensors and of their samples; the file is checked first."""
    verify(path)
    with _opened(path) as file:
        _require_layout(path, file)
        rows, sensors, samples = file["signals"].shape
    return rows, sensors, samples


@contextmanager
def _opened(path: Path) -> Iterator[h5py.File]:
    """A file to read; every error of the library about its content becomes a ValueError."""
    try:
        with opened(path) as file:
            yield file
    except FileNotFoundError:
        raise
    except (OSError, RuntimeError, LookupError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: not a file of recordings as they are written ({error}); generate it again"
        ) from error


def _require_layout(path: Path, file: h5py.File) -> None:
    """Raise a ValueError unless every variable is stored in the file itself with the expected layout.

    Anybody can seal a file. Variables that are compressed, replaced by a fill value or stored in another file were not
    written here; they could fill the memory or bring foreign numbers.
    """
    layout = {"signals": ("f4", 3)} | {name: (column.dtype, 1) for name, column in COLUMNS.items()}
    size = path.stat().st_size
    for name, (dtype, axes) in layout.items():
        variable = file[name] if isinstance(file.get(name, getlink=True), h5py.HardLink) else None
        if not isinstance(variable, h5py.Dataset) or variable.is_virtual or variable.external:
            raise ValueError(f"{name} is no variable in the file itself")
        if variable.dtype != dtype or len(variable.shape or ()) != axes:
            raise ValueError(f"{name} is {variable.dtype} of shape {variable.shape}, must be {dtype} with {axes} axes")
        if len(variable) != len(file["signals"]) or not len(variable):
            raise ValueError(
                f"{name} has {len(variable)} recordings, signals {len(file['signals'])}: as many, and some"
            )
        size -= variable.size * variable.dtype.itemsize
    if size < 0:
        raise ValueError("more numbers than the file can hold")
