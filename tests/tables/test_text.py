"""Text tables: every number is read as it is written, and a message names row, column and the entry that helps."""

import gzip
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swgsim.tables import limits
from swgsim.tables.any_table import read_table
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.head_facts import head_facts
from swgsim.tables.layout import Layout, read_layout
from swgsim.tables.table_map import TableMap
from swgsim.tables.text import read_text

NAMES = "t,q,note\n"


def read(folder: Path, text: str | bytes, wanted: list[str | int], texts: tuple[str, ...] = (), **layout: Any) -> dict:
    path = folder / "log.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_text(path, path.name, wanted, read_layout(layout), texts)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    values=st.lists(st.floats(-1e300, 1e300, allow_nan=False), min_size=2, max_size=8),
    separator=st.sampled_from([",", ";", "tab", "blanks", "|"]),
    decimal=st.sampled_from([".", ","]),
    encoding=st.sampled_from(["utf-8", "utf-16", "cp1252"]),
    preamble=st.integers(0, 3),
    ending=st.sampled_from(["\n", "\r\n"]),
)
def test_every_number_comes_back_exactly(
    tmp_path_factory: pytest.TempPathFactory, values: list[float], separator: str, decimal: str, encoding: str,
    preamble: int, ending: str,
) -> None:  # fmt: skip
    sign = {"tab": "\t", "blanks": "  "}.get(separator, separator)
    if sign == decimal:
        return
    rows = ["of the recorder"] * preamble + [sign.join(["a", "ü"])]
    rows += [sign.join([str(value).replace(".", decimal), "1"]) for value in values]
    layout = {"separator": separator, "decimal": decimal, "encoding": encoding, "header_row": preamble + 1}
    text = (ending.join(rows) + ending).encode(encoding)
    found = read(tmp_path_factory.mktemp("text"), text, ["a", "ü"], **layout)
    np.testing.assert_array_equal(found["a"].astype(float), values)


def test_only_named_columns_are_looked_at(tmp_path: Path) -> None:
    text = '"t","q, angle",note,note,\n0,1.5,OK,,\n1,2.5,,x\n2,3.5\n'
    np.testing.assert_array_equal(read(tmp_path, text, ["q, angle"])["q, angle"], [1.5, 2.5, 3.5])
    with pytest.raises(FileDefect, match=r"row 1: found 2 columns 'note', 'note'.*its number from 1"):
        read(tmp_path, text, ["note"])
    np.testing.assert_array_equal(read(tmp_path, text, [1], header=False, first_row=2)[1], [0, 1, 2])


def test_whole_numbers_keep_all_their_digits(tmp_path: Path) -> None:
    stamps = [1647000000123456789, 1647000000123456790]
    found = read(tmp_path, "t,x\n" + "".join(f"{each},1\n" for each in stamps), ["t"])["t"]
    assert found.tolist() == stamps


def test_groups_of_three_digits_are_one_number(tmp_path: Path) -> None:
    text = "t;q\n0;1.024,5\n1;12,25\n2;-2.000\n"
    found = read(tmp_path, text, ["q"], separator=";", decimal=",", thousands=".")["q"]
    assert found.tolist() == [1024.5, 12.25, -2000.0]
    with pytest.raises(FileDefect, match=r"row 3, column q: found '1\.02\.4'"):
        read(tmp_path, "t;q\n0;1.024\n1;1.02.4\n", ["q"], separator=";", decimal=",", thousands=".")


def test_lost_readings_are_no_numbers(tmp_path: Path) -> None:
    text = "t,q\n0,1\n1,nan\n2,\n3,-9999\n4,ERR\n5,6\n\n\n"
    found = read(tmp_path, text, ["t", "q"], lost={"values": [-9999, "ERR"]})
    np.testing.assert_array_equal(found["q"], [1, np.nan, np.nan, np.nan, np.nan, 6])
    assert found["t"].tolist() == [0, 1, 2, 3, 4, 5]


BAD: dict[str, tuple[str | bytes, dict[str, Any], str]] = {
    "same sign": ("t,q\n0,1\n", {"decimal": ","}, "separator and decimal are both ','.*set separator in a map"),
    "thousands": ("t;q\n0;1.024\n", {"separator": ";", "decimal": ","}, r"found '1\.024'.*decimal or thousands"),
    "semicolons": ("t;q\n0;1\n", {}, r"row 1: found 't;q'.*set separator: ';' in a map"),
    "decimal commas": ("t;q\n0;1,5\n", {"separator": ";"}, r"row 2, column q: found '1,5'.*set decimal: ','"),
    "commas of both kinds": ("t,q\n0,0,1,5\n", {}, r"row 2: found 4 cells, expected 2.*separator and decimal"),
    "Windows": ("t,q\n0,1\n°,2\n".encode("cp1252"), {}, r"row 3: found bytes that are not text.*such as cp1252"),
    "a program": (b"\x7fELF\x00\xff" + bytes(100), {}, "a binary file, expected text, or a file that ends in"),
    "UTF-16": ("t,q\n0,1\n".encode("utf-16"), {}, r"row 1: found the mark of text in UTF-16.*encoding: utf-16"),
    "units": ("t,q\ns,rad\n0,1\n", {}, r"row 2, column q: found 'rad'.*set first_row: 3 in a map"),
    "lines before": ("Recorder 7\nt,q\n0,1\n", {}, r"found the columns 'Recorder 7'.*row 2 has it: set header_row: 2"),
    "a word": ("t,q\n0,1\n1,lost\n", {}, r"row 3, column q: found 'lost'.*set lost: \{values: \['lost'\]"),
    "a word after comments": ("t,q\n0,1\n# a\n# b\n1,x\n", {"comment": "#"}, r"row 5, column q: found 'x'"),
    "too many cells": ("t,q\n0,1\n1,2,3\n", {}, r"row 3: found 3 cells, expected 2"),
    "names only": ("t,q\n", {}, "names without rows"),
    "nothing": ("", {}, "an empty file"),
    "nearly": ("t,qq\n0,1\n", {}, r"expected 'q', as the map says \(is 'qq' meant\?\)"),
    "hexadecimal": ("t,q\n0,0x1F\n1,2\n", {}, r"row 2, column q: found '0x1F'"),
    "underscore": ("t,q\n0,1_0\n", {}, "found '1_0'"),
    "truth": ("t,q\n0,True\n1,False\n", {}, "found 'True'"),
    "an open quote": ('t,q\n0,"1\n1,2\n', {}, "found .*quote|EOF|a number"),
    "a long line": ("t,q\n" + "1" * 200_000, {}, "a line of more than 100000 characters"),
}


@pytest.mark.parametrize("name", list(BAD))
def test_what_is_no_table_of_the_layout_is_named(tmp_path: Path, name: str) -> None:
    text, layout, message = BAD[name]
    with pytest.raises(FileDefect, match=message):
        read(tmp_path, text, ["q"], **layout)


LAYOUTS: dict[str, tuple[Callable[[], object], str]] = {
    "separator": (lambda: read_layout({"separator": "::"}), "must be one character, or one of tab, blanks"),
    "thousands": (lambda: read_layout({"thousands": "."}), "must be a sign such as '.' and not the decimal"),
    "decimal": (lambda: read_layout({"decimal": "x"}), "unknown choice 'x' of decimal signs"),
    "encoding": (lambda: read_layout({"encoding": "latin-99"}), "must be one such as utf-8, utf-16, cp1252"),
    "rows": (lambda: read_layout({"header_row": 3, "first_row": 3}), "must be after header_row 3"),
    "two": (lambda: read_layout({"header_row": 3, "header": False}), "keep one of them"),
    "comment": (lambda: read_layout({"comment": "//"}), "must be one character, such as '#'"),
    "lost": (lambda: read_layout({"lost": {"values": "x"}}), "must be a list such as"),
    "lost rows": (
        lambda: read_layout({"lost": {"leave_out": -1}}),
        "must be a number of rows up to 1000000, or a share",
    ),
    "number": (lambda: read_layout({"separator": 1}), "must be a text in quotes"),
}


@pytest.mark.parametrize("name", list(LAYOUTS))
def test_a_layout_without_sense_is_named(name: str) -> None:
    make, message = LAYOUTS[name]
    with pytest.raises(ValueError, match=message):
        make()


def test_what_is_compressed_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "log.csv.gz"
    path.write_bytes(gzip.compress(("t,q\n" + "1,1\n" * 100_000).encode()))
    assert len(read_text(path, path.name, ["q"], Layout())["q"]) == 100_000
    monkeypatch.setattr(limits, "ALWAYS_EXPANDED", 10_000)
    with pytest.raises(FileDefect, match=r"more text than its size allows.*write it less compressed"):
        read_text(path, path.name, ["q"], Layout())
    path.write_bytes(path.read_bytes()[:-20])
    monkeypatch.undo()
    with pytest.raises(FileDefect, match="a damaged file"):
        read_text(path, path.name, ["q"], Layout())


def test_a_list_in_a_cell_has_numbers(tmp_path: Path) -> None:
    """Of ROS 1 and 2; a column whose name has a number as it stands is no list; a short list is named by its row."""
    text = 'q,v,w[2]\n"[0.5, 1]","array(\'d\', [2, 3])",7\n"(4; 5)",,8\n'
    found = read(tmp_path, text, ["q[1]", "v[2]", "w[2]"])
    np.testing.assert_array_equal(found["q[1]"], [0.5, 4])
    np.testing.assert_array_equal(found["v[2]"], [3, np.nan])
    np.testing.assert_array_equal(found["w[2]"], [7, 8])
    with pytest.raises(FileDefect, match=r"row 2, column q\[3\]: found '\[0\.5, 1\]', a list of 2"):
        read(tmp_path, text, ["q[3]"])
    with pytest.raises(FileDefect, match=r"column q\[0\]: found element 0, expected a number from 1"):
        read(tmp_path, text, ["q[0]"])
    with pytest.raises(FileDefect, match=r"row 2, column .*: found 'a', expected a number"):
        read(tmp_path, 'q\n"[a, b]"\n', ["q[1]"])


def test_tables_below_one_another_are_told_apart(tmp_path: Path) -> None:
    """Lines between them are of no table; a row of units follows the names of each; messages count rows of the file."""
    text = "drive 3\nt;q\ns;rad\n0;1\n1;2\n\ndrive 4\nOperator;me\nt;q\ns;rad\n0;x\n"
    path = tmp_path / "a.txt"
    path.write_text(text, encoding="utf-8")
    layout = Layout(separator=";", header_row=2, first_row=4, sheet="1")
    table, row = read_table(path, "a.txt", ["q"], [], layout)
    np.testing.assert_array_equal(table["q"], [1, 2])
    assert row == 4
    with pytest.raises(FileDefect, match=r"a\.txt, row 11, column q: found 'x'"):
        read_table(path, "a.txt", ["q"], [], replace(layout, sheet="2"))
    with pytest.raises(
        FileDefect, match=r"row 3, column q: found 'q', expected a number; the row of names again.*each"
    ):
        read(tmp_path, "t,q\n0,1\nt,q\n0,1\n", ["q"])
    path.write_text(text.replace("1;2\n", "1;2\n2\n"), encoding="utf-8")  # the recorder was stopped within a row
    np.testing.assert_array_equal(read_table(path, "a.txt", ["q"], [], layout)[0]["q"], [1, 2, np.nan])
    with pytest.raises(FileDefect, match=r"2 tables with the same row of names, expected a sheet from 1 to 2, not '3'"):
        read_table(path, "a.txt", ["q"], [], replace(layout, sheet="3"))


HEADED = "Speed: 2000 rpm\nLoad: 39,5 Nm\nt;x\n0;1\n1;2\n"


def test_lines_before_the_numbers_give_facts(tmp_path: Path) -> None:
    """In the decimal sign of the table, and from no line of numbers."""
    path = tmp_path / "a.txt"
    path.write_text(HEADED, encoding="utf-8")
    speed, load = r"Speed: (?P<n_in_rpm>\d+) rpm", r"Load: (?P<T_out_nm>[\d,]+) Nm"
    table = TableMap(Layout(separator=";", decimal=",", header_row=3), head=(speed, load))
    assert head_facts(path, "a.txt", table) == {"n_in_rpm": "2000", "T_out_nm": "39.5"}
    with pytest.raises(FileDefect, match=r"a\.txt: found nothing like .*0;1.* in rows 1 to 3, expected what 'head'"):
        head_facts(path, "a.txt", replace(table, head=("(?P<repeat>0;1)",)))
    with pytest.raises(FileDefect, match=r"no lines of text before the numbers"):
        head_facts(path.with_suffix(".mat"), "a.mat", table)
    path.write_text(HEADED.replace("2000", "2.000"), encoding="utf-8")
    dotted = replace(table, layout=replace(table.layout, thousands="."), head=(r"Speed: (?P<n_in_rpm>[\d.]+) rpm",))
    assert head_facts(path, "a.txt", dotted) == {"n_in_rpm": "2000"}


def test_bare_numbers_are_one_column_of_whole_numbers(tmp_path: Path) -> None:
    path, layout = tmp_path / "a.bin", Layout(raw=">i2", header_row=0)
    path.write_bytes(np.arange(20, dtype=">i2").tobytes())
    np.testing.assert_array_equal(read_table(path, "a.bin", [1], [], layout)[0][1], np.arange(20))
    with pytest.raises(FileDefect, match=r"column '2' in a file of bare numbers, expected column 1.*interleaved"):
        read_table(path, "a.bin", [2], [], layout)
    path.write_bytes(bytes(41))
    with pytest.raises(FileDefect, match=r"a\.bin: found 41 bytes, expected whole numbers of 2 bytes, as '>i2' has"):
        read_table(path, "a.bin", [1], [], layout)
    with pytest.raises(ValueError, match="unknown choice 'int12' of raw"):
        Layout(raw="int12")
