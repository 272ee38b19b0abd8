"""Recordings as one HDF5 file in NetCDF-4 layout: one group each, with the seal of data sets (swgsim/storage)."""

from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np

from swgsim.common.files import replacing
from swgsim.recordings.files import facts
from swgsim.recordings.files.assembly import assemble, require_alike, require_sound
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.storage.attributes import attribute, set_attributes
from swgsim.storage.hdf5_reader import opened
from swgsim.storage.hdf5_writer import created
from swgsim.storage.storage import SEAL_SIZE, seal, verify
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.limits import require_file_count, require_readable, require_rows

TITLE = "recordings of strain wave gears"


def write_file(path: str | Path, recordings: Sequence[Recording]) -> None:
    """Write recordings as one file, which is complete or absent; reading gives back every number exactly.

    Raises
    ------
    ValueError
        If a recording could not be read back.
    """
    path = Path(path)
    require_file_count(path, len(recordings))
    require_alike(recordings)
    with replacing(path) as aside:
        with created(aside, SEAL_SIZE) as (file, _):
            set_attributes(file, Conventions="CF-1.11", title=TITLE)
            for number, recording in enumerate(recordings, 1):
                _write_group(file.create_group(f"recording_{number:04d}"), recording)
        seal(aside)


def read_file(path: Path) -> tuple[Recording, ...]:
    """The recordings of a file, in the order in which they were written.

    Raises
    ------
    ValueError
        If the file is damaged or holds no recordings.
    """
    require_readable(path)
    verify(path)
    try:
        with opened(path) as file:
            title = attribute(file, "title")
            if title != TITLE:
                expected = f"a file titled {TITLE!r}; data sets of swg generate have another layout"
                raise FileDefect(str(path), f"the title {shown(title)}", expected)
            require_file_count(path, len(file))
            _require_all_inside(path, file)
            recordings = tuple(_read_group(file, name, f"{path}:{name}") for name in sorted(file))
    except FileDefect:
        raise
    # The library raises errors of many kinds for damaged bytes; anybody can seal those.
    except (OSError, RuntimeError, LookupError, TypeError, ValueError) as error:
        raise FileDefect(str(path), f"no HDF5 file of recordings ({error})", "a file of write_file") from None
    require_alike(recordings)
    return recordings


def _require_all_inside(path: Path, file: h5py.File) -> None:
    """Raise unless the file has room for all its numbers.

    write_file compresses nothing. If the numbers exceed the size of the file, they are compressed, replaced by a fill
    value or stored under several names, and may fill the memory.
    """
    size = path.stat().st_size
    for name in file:
        group = _plain(file, name, h5py.Group, f"{path}:{name}")
        for key in group:
            variable = _plain(group, key, h5py.Dataset, f"{path}:{name}")
            size -= (variable.size or 0) * variable.dtype.itemsize
    if size < 0:
        raise FileDefect(str(path), "more numbers than the file has room for", "numbers that are not compressed")


def _write_group(group: h5py.Group, recording: Recording) -> None:
    """Time as a coordinate, channels along it, facts as attributes."""
    known = facts.of(recording)
    facts.parse(known, f"recording {recording.name}")
    require_sound(f"recording {recording.name}", {"t": recording.time, **recording.channels})
    set_attributes(group, **known)
    time = group.create_dataset("time", data=recording.time, dtype="f8", chunks=True, fletcher32=True)
    time.make_scale("time")
    set_attributes(time, units="s", long_name="time")
    for name, values in recording.channels.items():
        variable = group.create_dataset(name, data=values, dtype="f8", chunks=True, fletcher32=True)
        set_attributes(variable, units=CHANNELS[name].unit, long_name=CHANNELS[name].meaning)
        variable.dims[0].attach_scale(time)


def _read_group(file: h5py.File, name: str, where: str) -> Recording:
    """One recording; its units must be those of the channels."""
    group = _plain(file, name, h5py.Group, where)
    attributes = {key: attribute(group, key) for key in facts.KNOWN if key in group.attrs}
    known = facts.parse(attributes, where)
    columns = {}
    for key in group:
        if key != "time" and key not in CHANNELS:
            raise FileDefect(where, f"unknown variable {shown(key)}", f"time and some of {', '.join(CHANNELS)}")
        unit = "s" if key == "time" else CHANNELS[key].unit
        variable = _plain(group, key, h5py.Dataset, where)
        if (found := attribute(variable, "units")) != unit:
            raise FileDefect(where, f"unit {shown(found)}", unit, column=key)
        columns["t" if key == "time" else key] = _numbers(variable, where, key)
    lengths = {key: len(values) for key, values in columns.items()}
    if "t" not in columns or len(set(lengths.values())) != 1:
        raise FileDefect(where, f"lengths {lengths}", "a time and as many values of every channel")
    return assemble(where, known, columns)


def _plain(group: h5py.Group, name: str, kind: type, where: str) -> h5py.Group | h5py.Dataset:
    """Group or data set of a name; links are refused, as they may lead out of the file."""
    if not isinstance(group.get(name, getlink=True), h5py.HardLink) or not isinstance(group[name], kind):
        raise FileDefect(where, f"{shown(name)}, which is a link or of another kind", f"a {kind.__name__.lower()}")
    return group[name]


def _numbers(variable: h5py.Dataset, where: str, column: str) -> np.ndarray:
    """The values of one variable: real numbers in one row or column.

    Raises
    ------
    FileDefect
        If the variable holds anything else, or its data are in another file.
    """
    if variable.is_virtual or variable.external:
        raise FileDefect(where, "data in another file", "data in the file itself", column=column)
    if variable.dtype.kind not in "fiu" or sum(length != 1 for length in variable.shape) != 1:
        found = f"{variable.dtype} of shape {variable.shape}"
        raise FileDefect(where, found, "real numbers in one row or column", column=column)
    require_rows(where, variable.size)
    return variable[()].astype("f8").ravel()
