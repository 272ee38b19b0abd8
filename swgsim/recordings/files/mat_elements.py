"""A variable of a MATLAB file of version 5, element by element up to its numbers.

Tables 1-1 to 1-3 of MATLAB's description of the format have the numbers of types and classes.
"""

import struct
import zlib
from math import prod
from typing import BinaryIO, NamedTuple

from swgsim.recordings.files.file_defect import FileDefect, shown

INT8, INT32, UINT32, MATRIX, COMPRESSED, UTF8 = 1, 5, 6, 14, 15, 16
# Bytes of the types that are numbers.
SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8}
NUMBERS = {6: "double", 7: "single"} | {8 + i: f"{'u' * (i % 2)}int{8 << i // 2}" for i in range(8)}
OTHERS = {1: "cell", 2: "struct", 3: "object", 4: "char", 5: "sparse", 16: "function", 18: "object"}
COMPLEX, LOGICAL = 0x800, 0x200

MOST_DIMENSIONS = 32
LONGEST_NAME = 1000  # bytes; MATLAB allows 63 letters
HEAD = 2048  # bytes, in which the tag of the numbers lies, whatever dimensions and name
PACKED = 2**16  # bytes, of which a head is inflated


class Variable(NamedTuple):
    """What a file says of a variable; its kind is a class of MATLAB, with ``complex`` or ``logical`` where it is so."""

    name: str
    shape: tuple[int, ...]
    kind: str


class _Element(NamedTuple):
    """Type and bytes of an element, where they begin, and where the next element does."""

    type: int
    size: int
    start: int
    next: int


def variable(stream: BinaryIO, order: str, file: str) -> tuple[Variable, int]:
    """The variable that begins where a file was read to, and where it ends.

    Parameters
    ----------
    stream : BinaryIO
    order : str
        Of bytes, ``<`` or ``>``.
    file : str
        What messages call it.

    Raises
    ------
    FileDefect
        If an element is of a type or a size that it cannot have there.
    """
    tag = stream.read(8)
    outer = _element(tag, 0, order, file)
    end = stream.tell() + outer.size
    if outer.type != COMPRESSED:
        return _matrix(tag + stream.read(min(outer.size, HEAD)), order, file), end
    try:
        raw = zlib.decompressobj().decompress(stream.read(min(outer.size, PACKED)), HEAD)
    except zlib.error as error:
        raise FileDefect(file, f"damaged compression ({error})", "a sound one") from None
    return _matrix(raw, order, file), end


def _matrix(raw: bytes, order: str, file: str) -> Variable:
    """A variable by the first bytes of its element."""
    matrix = _element(raw, 0, order, file)
    require(matrix.type == MATRIX and matrix.start == 8, file, f"an element of type {matrix.type}", "a variable")
    flags = _element(raw, 8, order, file)
    require(flags[:2] == (UINT32, 8), file, f"flags of type {flags.type}, {flags.size} bytes", "8 bytes of uint32")
    bits = struct.unpack(order + "2I", _content(raw, flags, file))[0]
    kind = (NUMBERS | OTHERS).get(bits & 0xFF)
    if kind is None:  # also 17, which has no dimensions
        expected = "numbers, text, cells or structs: leave out tables, strings, dates and objects when you save"
        raise FileDefect(file, f"a variable of class {bits & 0xFF}", expected)
    sizes = _element(raw, flags.next, order, file)
    sound = sizes.type in (INT32, UINT32) and sizes.size in range(8, 4 * MOST_DIMENSIONS + 1, 4)
    require(sound, file, f"dimensions of type {sizes.type}, {sizes.size} bytes", f"2 to {MOST_DIMENSIONS} int32")
    shape = struct.unpack(f"{order}{sizes.size // 4}i", _content(raw, sizes, file))
    require(min(shape) >= 0, file, f"dimensions {shown(shape)}", "none below 0")
    title = _element(raw, sizes.next, order, file)
    sound = title.type in (INT8, UTF8) and title.size <= LONGEST_NAME
    require(sound, file, f"a name of type {title.type}, {title.size} bytes", f"at most {LONGEST_NAME} letters")
    name = _content(raw, title, file).decode("latin1")
    if kind in NUMBERS.values() and not bits & COMPLEX:
        data, end = _element(raw, title.next, order, file), matrix.start + matrix.size
        sound = data.type in SIZES and data.size == prod(shape) * SIZES[data.type]
        found = f"type {data.type} and {data.size} bytes for {kind} of shape {shown(shape)}"
        require(sound, file, found, "a type of numbers, and one for each place", name)
        padded = data.start + data.size <= end <= data.next
        require(padded, file, f"{end - data.start} bytes for {data.size} of numbers", "the numbers, and no more", name)
    words = ("complex",) * bool(bits & COMPLEX) + ("logical",) * bool(bits & LOGICAL)
    return Variable(name, shape, " ".join((*words, kind)))


def _element(raw: bytes, at: int, order: str, file: str) -> _Element:
    """The element of which the tag begins there; the tag itself may hold up to 4 bytes."""
    require(len(raw) >= at + 8, file, "a variable that ends in its head", "all of it")
    kind, size = struct.unpack_from(order + "2I", raw, at)
    if not kind >> 16:
        return _Element(kind, size, at + 8, at + 8 + size + -size % 8)
    require(kind >> 16 <= 4, file, f"{kind >> 16} bytes within a tag", "at most 4")
    return _Element(kind & 0xFFFF, kind >> 16, at + 4, at + 8)


def _content(raw: bytes, element: _Element, file: str) -> bytes:
    """The bytes of an element."""
    found = raw[element.start : element.start + element.size]
    require(len(found) == element.size, file, "a variable that ends in its head", "all of it")
    return found


def require(sound: bool, file: str, found: str, expected: str, column: str | None = None) -> None:
    """Raise a FileDefect unless it is as it has to be."""
    if not sound:
        raise FileDefect(file, found, expected, column=column)
