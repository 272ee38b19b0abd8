"""The HDF5 file of recordings: other programs open it, damage and other contents are named."""

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from recording_fixtures import recording

from swgsim.recordings.files.recording_file import TITLE, read_file, write_file
from swgsim.tables.file_defect import FileDefect

ROWS = 60
GOOD = (recording(1, ROWS), recording(2, ROWS))


def test_xarray_opens_the_file_with_units(tmp_path: Path) -> None:
    write_file(tmp_path / "bench.h5", GOOD)
    with xarray.open_dataset(tmp_path / "bench.h5", engine="h5netcdf", group="recording_0002") as data:
        assert data["s1"].dims == ("time",)
        assert data["s1"].attrs["units"] == "mV/V"
        assert data["time"].attrs["units"] == "s"
        assert data.attrs["T_out_nm"] == 39.5
        np.testing.assert_array_equal(data["phi_in"].values, GOOD[1].channels["phi_in"])
    with h5py.File(tmp_path / "bench.h5") as file:
        assert all(variable.fletcher32 for variable in file["recording_0001"].values())


def test_a_damaged_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bench.h5"
    write_file(path, GOOD)
    content = bytearray(path.read_bytes())
    content[20_000] ^= 1
    for damaged, message in ((content, "damaged or truncated"), (content[:100], "not a file of recordings")):
        path.write_bytes(damaged)
        with pytest.raises(ValueError, match=rf"bench\.h5: {message}"):
            read_file(path)


OTHER_CONTENTS: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "title": (lambda f: f.attrs.__setitem__("title", np.bytes_("other")), "the title 'other'"),
    "no fact": (lambda f: f["recording_0001"].attrs.__delitem__("gear"), "found no gear"),
    "unknown unit": (lambda f: f["recording_0001/s1"].attrs.__setitem__("units", np.bytes_("V/V")), "found unit 'V/V'"),
    "unknown variable": (lambda f: f["recording_0001"].create_dataset("x", data=np.ones(ROWS)), "unknown variable 'x'"),
    "no time": (lambda f: f["recording_0001"].__delitem__("time"), "found lengths"),
    "external link": (
        lambda f: f.__setitem__("recording_0003", h5py.ExternalLink("other.h5", "/")), "which is a link",
    ),
    "soft link": (lambda f: f.__setitem__("recording_0003", h5py.SoftLink("/recording_0001")), "which is a link"),
    "text": (
        lambda f: (f["recording_0001"].__delitem__("s1"), f["recording_0001"].create_dataset("s1", data=["a"] * ROWS),
                   f["recording_0001/s1"].attrs.__setitem__("units", np.bytes_("mV/V"))),
        "expected real numbers",
    ),
    "empty": (lambda f: f.clear(), "found 0 recordings"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(OTHER_CONTENTS))
def test_a_sealed_file_with_other_contents_is_named(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    change, message = OTHER_CONTENTS[name]
    path = tmp_path / "bench.h5"
    write_file(path, GOOD)
    with h5py.File(path, "r+") as file:
        assert file.attrs["title"].decode() == TITLE
        change(file)
    monkeypatch.setattr("swgsim.recordings.files.recording_file.verify", lambda path: None)
    with pytest.raises(FileDefect, match=message):
        read_file(path)
