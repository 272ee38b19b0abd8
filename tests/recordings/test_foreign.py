"""Files of other formats and their column map: every format is read, damage is named, numbers are those of the file."""

import struct
import zlib
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_fixtures import ROWS, SAVERS, SHORT, assert_sound, columns, mapped
from scipy.io import savemat
from scipy.sparse import eye_array

from swgsim.recordings.files import facts
from swgsim.recordings.files.source_map import SourceMap, read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.recordings.recording import Recording
from swgsim.tables import binary
from swgsim.tables.binary import read_columns
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats import limited
from swgsim.tables.formats.contents import NUMBERS
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.limits import LARGEST_NUMBER, SMALLEST_STEP

# A warning stops no reader in use, and so not here.
pytestmark = pytest.mark.filterwarnings("ignore")
FUZZ = settings(deadline=None, derandomize=True)
TIME = np.arange(24.0)


@pytest.mark.parametrize("saver", list(SAVERS))
def test_every_format_is_read_through_a_map(tmp_path: Path, saver: str) -> None:
    folder, path = mapped(tmp_path, saver, SHORT)
    found = read_mapped(folder, read_map(path)).recordings
    assert [each.name for each in found] == ["run1", "run2"]
    for one, other in zip(found, SHORT, strict=True):
        assert one.point == other.point
        assert (one.gear, one.session, one.repeat) == ("A17", "monday", other.repeat)
        np.testing.assert_allclose(one.time, other.time, rtol=1e-14)
        for name, values in other.channels.items():
            np.testing.assert_allclose(one.channels[name], values, rtol=1e-9, atol=1e-12)


# MATLAB files of versions 4 and 5.


@pytest.fixture(scope="module")
def reader() -> Any:
    with LimitedReader() as process:
        yield process


def read(path: Path, content: bytes, reader: LimitedReader) -> np.ndarray:
    path.write_bytes(content)
    return read_columns(path, path.name, ["Time"], reader)["Time"]


@pytest.mark.parametrize("options", [{}, {"do_compression": True}, {"format": "4"}], ids=["5", "compressed", "4"])
def test_numbers_are_read_next_to_variables_of_all_kinds(tmp_path: Path, reader: LimitedReader, options: dict) -> None:
    others = {"Text": "a text", "Sparse": eye_array(4, format="csc"), "Complex": TIME + 1j}
    if not options.get("format"):
        others |= {"Cells": np.array([1.0, "a", {"b": 2.0}], object), "Struct": {"a": TIME}, "Empty": np.zeros((0, 3))}
    savemat(tmp_path / "a.mat", {**others, "Time": TIME}, **options)
    assert read_columns(tmp_path / "a.mat", "a.mat", ["Time"], reader)["Time"].tolist() == TIME.tolist()
    for name in others:
        with pytest.raises(FileDefect, match=f"a.mat.*column {name}.*expected real numbers|found [01] samples"):
            read_columns(tmp_path / "a.mat", "a.mat", [name], reader)


@pytest.mark.parametrize("kind", [kind for kind in NUMBERS if kind in ("double", "single") or "int" in kind])
def test_every_type_of_number_is_read(tmp_path: Path, reader: LimitedReader, kind: str) -> None:
    path = tmp_path / "a.mat"
    for compressed in (False, True):
        savemat(
            path, {"Time": TIME.astype({"double": "f8", "single": "f4"}.get(kind, kind))}, do_compression=compressed
        )
        assert [(each.shape, each.kind) for each in binary.listed(path, "a.mat", reader)] == [((1, 24), kind)]
        assert read_columns(path, "a.mat", ["Time"], reader)["Time"].tolist() == TIME.tolist()


def element(kind: int, content: bytes, size: int | None = None) -> bytes:
    """An element of the format, which may claim another size."""
    return struct.pack("<2I", kind, len(content) if size is None else size) + content + bytes(-len(content) % 8)


PARTS = {
    "flags": element(6, struct.pack("<2I", 6, 0)),
    "dimensions": element(5, struct.pack("<2i", 24, 1)),
    "name": struct.pack("<2H", 1, 4) + b"Time",
    "numbers": element(9, TIME.tobytes()),
}


def matrix(**parts: bytes) -> bytes:
    return element(14, b"".join((PARTS | parts).values()))


def file_of(raw: bytes, compressed: bool = False) -> bytes:
    if compressed:
        packed = zlib.compress(raw)
        raw = struct.pack("<2I", 15, len(packed)) + packed
    return b"MATLAB 5.0".ljust(124) + b"\x00\x01IM" + raw


FALSE_PARTS = {
    "class of no number": {"flags": element(6, struct.pack("<2I", 0, 0))},
    "class without dimensions": {"flags": element(6, struct.pack("<2I", 17, 0))},
    "33 dimensions": {"dimensions": element(5, bytes(4 * 33))},
    "negative dimensions": {"dimensions": element(5, struct.pack("<2i", -24, -1))},
    "dimensions of 32 EB": {"dimensions": element(5, struct.pack("<2i", 2**31 - 1, 2**31 - 1))},
    "name of 4 GiB": {"name": element(1, b"", size=2**32 - 8)},
    "type 8, which ends SciPy": {"numbers": element(8, TIME.tobytes())},
    "type beyond the table": {"numbers": element(60000, TIME.tobytes())},
    "matrix in place of numbers": {"numbers": element(14, TIME.tobytes())},
    "numbers of 4 GiB": {"numbers": element(9, b"", size=2**32 - 8)},
    "numbers beyond their matrix": {"numbers": element(9, b"", size=192)},
}
OLD = struct.pack("<5i", 0, 24, 1, 0, 5) + b"Time\0" + TIME.tobytes()
FALSE_FILES = {
    **{name: file_of(matrix(**parts)) for name, parts in FALSE_PARTS.items()},
    **{name + ", compressed": file_of(matrix(**FALSE_PARTS[name]), compressed=True) for name in list(FALSE_PARTS)[4:7]},
    "no version": file_of(matrix()).replace(b"IM", b"XX"),
    "no compression": file_of(element(15, bytes(64))),
    "truncated": file_of(matrix())[:-8],
    "version 4, back to the beginning": OLD.replace(b"\x18\0\0\0\x01", b"\xfd\xff\xff\xff\x01"),
    "version 4, name of 2 GiB": OLD.replace(b"\x05\0\0\0T", b"\xff\xff\xff\x7fT"),
    "version 4, more numbers": OLD.replace(b"\x18\0\0\0\x01", b"\xff\xff\xff\x7f\x01"),
}


def test_false_matlab_files_are_named_and_harm_nobody(tmp_path: Path, reader: LimitedReader) -> None:
    """One test for all files, as those that end the child make the next one start it again."""
    for sound in (file_of(matrix()), file_of(matrix(), compressed=True), OLD):
        assert read(tmp_path / "a.mat", sound, reader).tolist() == TIME.tolist()
    for name, content in FALSE_FILES.items():
        with pytest.raises(FileDefect, match=r"^a\.mat"):
            raise AssertionError(f"{name} was read: {read(tmp_path / 'a.mat', content, reader)}")


def test_a_reader_that_takes_too_long_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    savemat(tmp_path / "a.mat", {"Time": np.zeros(10_000_000)}, do_compression=True)
    monkeypatch.setattr(limited, "OWN_SECONDS", 0.02)
    monkeypatch.setattr(limited, "BYTES_PER_SECOND", 1e12)
    with LimitedReader() as slow, pytest.raises(FileDefect, match="or 0 s: its reader ended with status -27"):
        read_columns(tmp_path / "a.mat", "a.mat", ["Time"], slow)


# The bytes of a file.


class Sound(NamedTuple):
    """A sound file, its map, its recording, and the reader of MATLAB files."""

    form: str
    file: Path
    content: bytes
    source: SourceMap
    recording: Recording

    def read(self, content: bytes) -> Recording | FileDefect:
        """The recording of other bytes, or their refusal."""
        self.file.write_bytes(content)
        try:
            (found,) = read_mapped(self.file.parent, self.source).recordings
        except FileDefect as refusal:
            return refusal
        return found


def sound_file(place: Path, form: str) -> Sound:
    folder, path = mapped(place, form)
    (file,) = folder.iterdir()
    (recording,) = read_mapped(folder, read_map(path)).recordings
    return Sound(form, file, file.read_bytes(), read_map(path), recording)


@pytest.fixture(scope="module", params=["v5 compressed.mat", "v73.mat", "plain.parquet", "snappy.parquet"])
def sound(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Sound:
    return sound_file(tmp_path_factory.mktemp("sound"), request.param)


def arrays(recording: Recording) -> dict[str, np.ndarray]:
    return {"t": recording.time, **recording.channels}


@pytest.fixture(scope="module", autouse=True)
def one_child(reader: LimitedReader) -> Any:
    """One child process for all readings of this module: hypothesis reads hundreds of files."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("swgsim.recordings.files.sources.LimitedReader", lambda: nullcontext(reader))
        yield


@settings(FUZZ, max_examples=60)
@given(data=st.data())
def test_damage_is_named_or_leaves_a_sound_recording(sound: Sound, data: st.DataObject) -> None:
    """Changed bytes and a missing end; without a checksum, a plausible changed number stays unnoticed."""
    where = st.integers(0, len(sound.content) - 1)
    raw = bytearray(sound.content)
    for at, byte in data.draw(st.dictionaries(where, st.integers(0, 255), max_size=4)).items():
        raw[at] = byte
    content = bytes(raw[: data.draw(st.just(len(raw)) | where)])
    found = sound.read(content)
    if isinstance(found, FileDefect):
        assert found.file == sound.file.name
        assert content != sound.content
        return
    assert_sound(found)
    assert facts.of(found) == facts.of(sound.recording)
    assert list(found.channels) == list(sound.recording.channels)
    assert len(found.time) == ROWS
    if sound.form == "v5 compressed.mat" or content == sound.content:  # a checksum covers every number
        for name, values in arrays(sound.recording).items():
            np.testing.assert_array_equal(arrays(found)[name], values)


@pytest.fixture(scope="module", params=["v5.mat", "plain.parquet"])
def plain(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Sound:
    """A file with the numbers as they are in memory."""
    return sound_file(tmp_path_factory.mktemp("plain"), request.param)


@settings(FUZZ, max_examples=60)
@given(
    column=st.sampled_from([name for name in columns() if name != "EncoderAngle"]),  # which is unwrapped
    row=st.integers(0, ROWS - 1),
    raw=st.binary(min_size=8, max_size=8) | st.floats(width=64).map(lambda value: np.float64(value).tobytes()),
)
def test_other_bytes_of_a_number_are_that_number_and_no_other(plain: Sound, column: str, row: int, raw: bytes) -> None:
    """The number is read as it is, or named with its row and column if it is unfit for computation."""
    table = columns()
    where = plain.content.index(table[column].tobytes()) + 8 * row
    table[column][row] = np.frombuffer(raw)[0]
    values = {each.quantity: each.values(table[column]) for each in plain.source.channels if each.column == column}
    with np.errstate(over="ignore"):
        (changed,) = (values or {"t": table[column] * 1e-3}).items()
    expected = arrays(plain.recording) | dict([changed])
    usable = (np.abs(changed[1]) <= LARGEST_NUMBER).all()
    usable = usable and (np.diff(expected["t"]) >= SMALLEST_STEP).all()
    found = plain.read(plain.content[:where] + raw + plain.content[where + 8 :])
    if isinstance(found, FileDefect):
        assert not usable
        assert (found.file, found.column) == (plain.file.name, column)
        assert found.row in (row + 1, row + 2)  # a time may contradict only its successor
        return
    assert usable
    for name, values in expected.items():
        np.testing.assert_array_equal(arrays(found)[name], values)
