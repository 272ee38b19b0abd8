"""Universal files (UFF, UNV), by pyuff, in the child process: functions of time, which are data sets of type 58."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from zlib import crc32

import pyuff

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents, Listed, few

FUNCTION = 58
# Codes of the format: the abscissa is a time; its steps are even; the ordinate is complex.
TIME, EVEN = 17, 1
COMPLEX = (5, 6)
AXES = {0: "", 1: "X", 2: "Y", 3: "Z", 4: "RX", 5: "RY", 6: "RZ"}


@contextmanager
def opened(path: Path, file: str, wanted: Sequence[str | int] | None) -> Iterator[Contents]:
    """The functions of a file in their order, each named by its first line or by that, node and direction."""
    source = pyuff.UFF(str(path))
    numbers = few((number for number, kind in enumerate(source.get_set_types()) if kind == FUNCTION), file)
    heads = [source.read_sets(number, header_only=True) for number in numbers]

    def whole(place: int) -> Mapping[str, Any]:
        found = source.read_sets(numbers[place])
        count, claimed = len(found["data"]), int(found["num_pts"])
        if count != claimed:
            raise FileDefect(file, f"{count} of {claimed} values", "all of them", column=names[place])
        return found

    def listed(place: int, head: Mapping[str, Any]) -> Listed:
        kind = "complex128" if head["ord_data_type"] in COMPLEX else "float64"
        unit = head["ordinate_axis_units_lab"].strip()
        return Listed(names[place], (int(head["num_pts"]),), kind, "" if unit == "NONE" else unit, base(place, head))

    def base(place: int, head: Mapping[str, Any]) -> str:
        if head["abscissa_spec_data_type"] != TIME:
            return ""
        if head["abscissa_spacing"] == EVEN:
            return f"{int(head['num_pts'])} steps of {head['abscissa_inc']} s from {head['abscissa_min']} s"
        return f"{int(head['num_pts'])} uneven steps with checksum {crc32(whole(place)['x'].tobytes())}"

    names = _names(heads)
    entries = [listed(place, head) for place, head in enumerate(heads)]
    yield Contents(entries, lambda place: whole(place)["data"], lambda place: whole(place)["x"], ordered=True)


def _names(heads: Sequence[Mapping[str, Any]]) -> list[str]:
    """The first line of each function; with the place of the sensor where several have the same."""
    first = ["" if head["id1"].strip() == "NONE" else head["id1"].strip() for head in heads]
    count = Counter(first)
    places = [f"{head['rsp_node']}{'-' * (head['rsp_dir'] < 0)}{AXES.get(abs(head['rsp_dir']), '')}" for head in heads]
    both = zip(first, places, strict=True)
    return [name if name and count[name] == 1 else f"{name} {place}".strip() for name, place in both]
