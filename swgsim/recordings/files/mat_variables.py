"""The variables of a MATLAB file of version 5 or 4.

SciPy takes a file at its word: a type for a place in its memory, a size for memory to fill, one below 0 for a way back.
So all that it acts on is checked before: the heads of all variables, and the numbers of those that it is asked for.
What lies in cells, structs and objects it does not read for numbers; it is passed over here, too.
"""

import struct
from pathlib import Path
from typing import BinaryIO

from swgsim.recordings.files.file_defect import shown
from swgsim.recordings.files.mat_elements import LONGEST_NAME, Variable, require, variable

ORDERS = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}  # version and order of bytes, at the end of the head of a file
HEAD = 128  # bytes
MOST_VARIABLES = 100_000

# Of version 4: bytes of a number, and kinds of a matrix.
SIZES = (8, 4, 4, 2, 2, 1)
KINDS = ("double", "char", "sparse")


def variables(path: Path, file: str) -> list[Variable]:
    """All variables, in their order.

    Parameters
    ----------
    path : Path
    file : str
        What messages call it.

    Raises
    ------
    FileDefect
        If something is not as the format has it.
    """
    found: list[Variable] = []
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(HEAD)
        old = 0 in head[:4]  # a small integer; else text
        order = _order_4(head[:4]) if old else ORDERS.get(head[124:], "")
        require(bool(order), file, f"{shown(head[124:])} at byte 124", "a MATLAB file of version 4, 5 or 7.3")
        at = stream.seek(0 if old else HEAD)
        while at < size:
            require(len(found) < MOST_VARIABLES, file, "more variables", f"at most {MOST_VARIABLES}")
            one, end = (_variable_4 if old else variable)(stream, order, file)
            require(end <= size, file, f"{size} bytes", f"{end}, as a variable at byte {at} says")
            found.append(one)
            at = stream.seek(end)
    return found


def _order_4(start: bytes) -> str:
    """The order of bytes in which what a file of version 4 begins with is a small integer."""
    return "<" if 0 <= int.from_bytes(start, "little", signed=True) <= 5000 else ">"


def _variable_4(stream: BinaryIO, order: str, file: str) -> tuple[Variable, int]:
    """As :func:`swgsim.recordings.files.mat_elements.variable`, of version 4."""
    raw = stream.read(20)
    require(len(raw) == 20, file, "a variable that ends in its head", "all of it")
    code, rows, columns, imaginary, length = head = struct.unpack(order + "5i", raw)
    number, kind = code // 10 % 10, code % 10
    sound = code // 100 in (0, 10) and number < len(SIZES) and kind < len(KINDS) and imaginary in (0, 1)
    sound = sound and min(rows, columns) >= 0 and 0 < length <= LONGEST_NAME
    require(sound, file, f"a variable that begins with {shown(head)}", "type, shape and length of a name")
    name = stream.read(length).strip(b"\0").decode("latin1")
    size = rows * columns * SIZES[number] * (2 if imaginary and KINDS[kind] != "sparse" else 1)
    return Variable(name, (rows, columns), "complex " * imaginary + KINDS[kind]), stream.tell() + size
