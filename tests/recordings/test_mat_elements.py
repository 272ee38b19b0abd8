"""MATLAB files made element by element: all sound forms are read, each false one is named before SciPy acts on it."""

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat
from scipy.sparse import eye_array

from swgsim.recordings.files import mat_variables
from swgsim.recordings.files.file_defect import FileDefect
from swgsim.recordings.files.foreign import read_columns
from swgsim.recordings.files.mat_elements import NUMBERS
from swgsim.recordings.files.mat_variables import Variable, variables

TIME = np.arange(24.0)
BESIDE = {
    "Cells": np.array([1.0, "a", {"b": 2.0}], object),
    "Struct": {"a": np.arange(3), "b": {"c": "text"}},
    "Text": "a text",
    "Sparse": eye_array(4, format="csc"),
    "Complex": TIME + 1j,
    "Logical": TIME > 3,
    "Small": np.uint8(3),
    "Empty": np.zeros((0, 3)),
}
CLASSES = {name: number for number, name in NUMBERS.items()}


def element(kind: int, content: bytes, order: str = "<", size: int | None = None) -> bytes:
    """An element, which may say another size than it has."""
    said = len(content) if size is None else size
    return struct.pack(order + "2I", kind, said) + content + bytes(-len(content) % 8)


PARTS = {
    "flags": element(6, struct.pack("<2I", 6, 0)),
    "dimensions": element(5, struct.pack("<2i", 24, 1)),
    "name": struct.pack("<2H", 1, 4) + b"Time",
    "numbers": element(9, TIME.tobytes()),
}
OTHER = {"name": struct.pack("<2H", 1, 4) + b"Next"}
OLD = struct.pack("<5i", 0, 24, 1, 0, 5) + b"Time\0" + TIME.tobytes()


def file_of(*matrices: bytes, compressed: bool = False, order: str = "<") -> bytes:
    """A file of version 5 with elements as they are, or each compressed, which is not padded."""
    head = b"MATLAB 5.0".ljust(124) + struct.pack(order + "2H", 0x100, 0x4D49)
    packed = [struct.pack(order + "2I", 15, len(raw)) + raw for raw in map(zlib.compress, matrices)]
    return head + b"".join(packed if compressed else matrices)


def matrix(**parts: bytes) -> bytes:
    return element(14, b"".join((PARTS | parts).values()))


def read(path: Path, content: bytes) -> np.ndarray:
    path.write_bytes(content)
    return read_columns(path, path.name, ["Time"])["Time"]


@pytest.mark.parametrize("compressed", [False, True])
def test_numbers_are_read_beside_variables_of_all_kinds(tmp_path: Path, compressed: bool) -> None:
    path = tmp_path / "a.mat"
    savemat(path, {**BESIDE, "Time": TIME}, do_compression=compressed)
    np.testing.assert_array_equal(read_columns(path, path.name, ["Time"])["Time"], TIME)
    kinds = {each.name: each.kind for each in variables(path, path.name)}
    assert kinds == {
        "Cells": "cell", "Struct": "struct", "Text": "char", "Sparse": "sparse", "Complex": "complex double",
        "Logical": "logical uint8", "Small": "uint8", "Empty": "double", "Time": "double",
    }  # fmt: skip


@pytest.mark.parametrize("kind", list(CLASSES))
@pytest.mark.parametrize("compressed", [False, True])
def test_every_type_of_number_is_read(tmp_path: Path, kind: str, compressed: bool) -> None:
    path = tmp_path / "a.mat"
    savemat(path, {"Time": TIME.astype(kind)}, do_compression=compressed)
    assert variables(path, path.name) == [Variable("Time", (1, 24), kind)]
    np.testing.assert_array_equal(read_columns(path, path.name, ["Time"])["Time"], TIME)


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize(("kind", "dtype"), [(9, "f8"), (2, "u1"), (3, "i2")])
def test_numbers_of_either_order_and_in_a_smaller_type_are_read(
    tmp_path: Path, compressed: bool, kind: int, dtype: str
) -> None:
    for order in "<>":
        parts = [
            element(6, struct.pack(order + "2I", CLASSES["double"], 0), order),
            element(5, struct.pack(order + "2i", 24, 1), order),
            struct.pack(order + "I", 4 << 16 | 1) + b"Time",
            element(kind, TIME.astype(order + dtype).tobytes(), order),
        ]
        content = file_of(element(14, b"".join(parts), order), compressed=compressed, order=order)
        np.testing.assert_array_equal(read(tmp_path / "a.mat", content), TIME)


def test_version_4_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    savemat(path, {"Text": "a text", "Complex": TIME + 1j, "Sparse": eye_array(4), "Time": TIME}, format="4")
    np.testing.assert_array_equal(read_columns(path, path.name, ["Time"])["Time"], TIME)
    assert [each.kind for each in variables(path, path.name)] == ["char", "complex double", "sparse", "double"]
    np.testing.assert_array_equal(read(path, OLD), TIME)


FALSE_PARTS = {
    "flags of another size": ({"flags": element(6, bytes(16))}, "flags of type 6, 16 bytes"),
    "no class": ({"flags": element(6, struct.pack("<2I", 0, 0))}, "class 0"),
    "a class without dimensions": ({"flags": element(6, struct.pack("<2I", 17, 0))}, "class 17"),
    "complex": ({"flags": element(6, struct.pack("<2I", 0x806, 0))}, "'complex double'.*expected real numbers"),
    "one dimension": ({"dimensions": struct.pack("<2Hi", 5, 4, 24)}, "dimensions of type 5, 4 bytes"),
    "too many dimensions": ({"dimensions": element(5, bytes(4 * 33))}, "dimensions of type 5, 132 bytes"),
    "dimensions below 0": ({"dimensions": element(5, struct.pack("<2i", -24, -1))}, "none below 0"),
    "more places": ({"dimensions": element(5, struct.pack("<2i", 2**31 - 1, 2**31 - 1))}, "192 bytes for double"),
    "a name of 4 GiB": ({"name": element(1, b"", size=2**32 - 8)}, "a name of type 1, 4294967288 bytes"),
    "a name beyond its element": ({"name": element(1, b"", size=900)}, "ends in its head"),
    "a name of numbers": ({"name": element(9, b"Time")}, "a name of type 9"),
    "5 bytes in a tag": ({"name": struct.pack("<2H", 1, 5) + b"Time"}, "5 bytes within a tag"),
    "a type that there is not": ({"numbers": element(8, TIME.tobytes())}, "column Time: found type 8"),
    "a type beyond the table": ({"numbers": element(60000, TIME.tobytes())}, "column Time: found type 60000"),
    "numbers that are a matrix": ({"numbers": element(14, TIME.tobytes())}, "column Time: found type 14"),
    "numbers of 4 GiB": ({"numbers": element(9, b"", size=2**32 - 8)}, "type 9 and 4294967288 bytes"),
    "numbers beyond their matrix": ({"numbers": element(9, b"", size=192)}, "0 bytes for 192 of numbers"),
    "something after the numbers": ({"numbers": PARTS["numbers"] * 2}, "392 bytes for 192 of numbers"),
    "no numbers": ({"numbers": b""}, "ends in its head"),
}


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("false", list(FALSE_PARTS))
def test_a_false_part_is_named(tmp_path: Path, false: str, compressed: bool) -> None:
    parts, message = FALSE_PARTS[false]
    with pytest.raises(FileDefect, match=rf"^a\.mat.*{message}"):
        read(tmp_path / "a.mat", file_of(matrix(**parts), compressed=compressed))


FALSE_FILES = {
    "another order of bytes": (file_of(matrix()).replace(b"IM", b"XX"), "at byte 124"),
    "numbers outside of a variable": (file_of(PARTS["numbers"]), "an element of type 9"),
    "numbers that are compressed": (file_of(PARTS["numbers"], compressed=True), "an element of type 9"),
    "compressed twice": (file_of(file_of(matrix(), compressed=True)[128:], compressed=True), "an element of type 15"),
    "no compression": (file_of(element(15, bytes(64))), "damaged compression"),
    "an end in the numbers": (file_of(matrix())[:-8], "found 368 bytes, expected 376, as a variable at byte 128"),
    "an end in a tag": (file_of(matrix()) + bytes(4), "ends in its head"),
    "version 4, back to the beginning": (OLD.replace(b"\x18\0\0\0\x01", b"\xfd\xff\xff\xff\x01"), "begins with"),
    "version 4, a name of 2 GiB": (OLD.replace(b"\x05\0\0\0T", b"\xff\xff\xff\x7fT"), "begins with"),
    "version 4, more numbers": (OLD.replace(b"\x18\0\0\0\x01", b"\xff\xff\xff\x7f\x01"), "found 217 bytes"),
}


@pytest.mark.parametrize("false", list(FALSE_FILES))
def test_a_false_file_is_named(tmp_path: Path, false: str) -> None:
    content, message = FALSE_FILES[false]
    with pytest.raises(FileDefect, match=rf"^a\.mat.*{message}"):
        read(tmp_path / "a.mat", content)


def test_variables_without_end_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mat_variables, "MOST_VARIABLES", 3)
    np.testing.assert_array_equal(read(tmp_path / "a.mat", file_of(matrix(), *[matrix(**OTHER)] * 2)), TIME)
    with pytest.raises(FileDefect, match=r"^a\.mat: found more variables, expected at most 3"):
        read(tmp_path / "a.mat", file_of(matrix(), *[matrix(**OTHER)] * 3))


WORDS = st.sampled_from([0, 1, 8, 17, 2**15, 2**16, 2**24, 2**31 - 1, 2**31, 2**32 - 8, 2**32 - 1])


@settings(deadline=None, derandomize=True, max_examples=400)
@given(
    changes=st.dictionaries(st.integers(0, 13), WORDS | st.integers(0, 2**32 - 1), min_size=1, max_size=3),
    compressed=st.booleans(),
)
def test_other_words_of_a_head_are_named_or_leave_as_many_numbers(
    tmp_path_factory: pytest.TempPathFactory, changes: dict[int, int], compressed: bool
) -> None:
    """Also where a sum over what is compressed agrees, as of a file that was made so."""
    raw = bytearray(matrix() + matrix(**OTHER))
    for word, value in changes.items():
        raw[4 * word : 4 * word + 4] = value.to_bytes(4, "little")
    size = len(matrix())
    content = file_of(bytes(raw[:size]), bytes(raw[size:]), compressed=compressed)
    try:
        found = read(tmp_path_factory.getbasetemp() / "words.mat", content)
    except FileDefect:
        return
    assert len(found) == len(TIME)
