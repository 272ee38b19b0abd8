"""TDMS, MDF, UFF, Parquet and spreadsheets: numbers are those of the file, and times are those of the channels."""

import datetime
import decimal
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import openpyxl
import pandas as pd
import pytest
from format_fixtures import COLUMNS, COUNTS, ROWS, SAVED, STEP, TORQUE

from swgsim.tables import limits
from swgsim.tables.binary import IN_CHILD, is_binary, listed, read_columns
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats import limited
from swgsim.tables.formats.limited import LimitedReader
from swgsim.tables.formats.spreadsheet import cells, is_spreadsheet

# pyuff and asammdf leave files to the garbage collector after writing.
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(scope="module")
def reader() -> Iterator[LimitedReader]:
    with LimitedReader() as process:
        yield process


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("formats")
    for name, save in SAVED.items():
        save(place / name)
    return place


@pytest.mark.parametrize("name", list(COLUMNS))
def test_channels_and_their_time_are_read(folder: Path, reader: LimitedReader, name: str) -> None:
    torque, counts = COLUMNS[name]
    found = read_columns(folder / name, name, ["time", torque, counts], reader)
    np.testing.assert_allclose(found["time"], 0.5 + STEP * np.arange(ROWS), rtol=1e-12)
    np.testing.assert_allclose(found[torque], TORQUE, rtol=1e-11)  # an even UFF has 11 digits
    assert found[counts].tolist() == COUNTS.tolist()
    assert found[counts].dtype.kind == ("f" if name == "a.uff" else "i")
    assert {each.name: each.unit for each in listed(folder / name, name, reader)}["torque [Nm]"] == "Nm"


REFUSED = {
    "a.tdms": {
        ("torque [Nm]", "slow/n"): "different time bases .*'torque .Nm.': 40 steps of 0.001 s from 0.5 s; 'slow/n'",
        ("time", "stamp"): "no time base of stamp, expected one: map a column with the time",
        ("note",): "column note: found 'text'",
        ("n",): "'bench/n', 'slow/n'",
    },
    "a.mf4": {
        ("bench/n", "1/n"): "different time bases .*group 0.*group 1",
        ("time",): "different time bases",
        ("computed",): "column computed: found a conversion by a formula",
    },
    "a.uff": {
        ("torque*", 3): "different time bases .*uneven",
        ("time", "spectrum"): "no time base of spectrum",
        (5,): "found 4 columns",
    },
}


@pytest.mark.parametrize(("name", "wanted"), [(name, wanted) for name, each in REFUSED.items() for wanted in each])
def test_what_belongs_to_no_common_time_is_refused(
    folder: Path, reader: LimitedReader, name: str, wanted: tuple[str | int, ...]
) -> None:
    with pytest.raises(FileDefect, match=f"^{name}.*{REFUSED[name][wanted]}"):
        read_columns(folder / name, name, wanted, reader)


def test_stamps_keep_every_digit(folder: Path, reader: LimitedReader, tmp_path: Path) -> None:
    stamps = pd.Timestamp("2024-02-29T12:00:00.123456789") + pd.to_timedelta(np.arange(ROWS), "ns")
    pd.DataFrame({"stamp": stamps, "in_berlin": stamps.tz_localize("Europe/Berlin")}).to_parquet(tmp_path / "a.parquet")
    found = read_columns(tmp_path / "a.parquet", "a.parquet", ["stamp", "in_berlin"])
    assert found["stamp"].tolist() == stamps.as_unit("ns").astype("i8").tolist()
    assert (found["stamp"] - found["in_berlin"] == 3600 * 10**9).all()
    found = read_columns(folder / "a.tdms", "a.tdms", ["stamp"], reader)
    assert found["stamp"][1] - 10**9 * int(datetime.datetime(2024, 2, 29, 12, tzinfo=datetime.UTC).timestamp()) == 1000


def test_values_of_an_mdf_are_physical(folder: Path, reader: LimitedReader) -> None:
    found = read_columns(folder / "a.mf4", "a.mf4", ["scaled", "status", "gaps"], reader)
    np.testing.assert_allclose(found["scaled"], 0.5 * (COUNTS % 7) - 1)
    assert found["status"].tolist() == (COUNTS % 2).tolist()  # a number stays where the file has a text for it
    assert np.flatnonzero(np.isnan(found["gaps"])).tolist() == [3]


def test_older_mdf_shares_its_ending_with_text(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "a.dat").write_bytes((folder / "a.mdf").read_bytes())
    (tmp_path / "b.dat").write_text("t;q\n1;2\n")
    assert [is_binary(tmp_path / name) for name in ("a.dat", "b.dat", "c.dat")] == [True, False, False]
    assert read_columns(tmp_path / "a.dat", "a.dat", ["torque*"])["torque*"].tolist() == TORQUE.tolist()


def test_a_parquet_has_numbers_of_all_kinds(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    table = pd.DataFrame({"i": COUNTS, "f": TORQUE.astype("f4"), "b": COUNTS % 2 == 0})
    table["lost"] = pd.array([None, *range(1, ROWS)], "Int64")
    table["dec"] = [decimal.Decimal(1)] * ROWS
    table["when"] = [pd.NaT, *[pd.Timestamp(0)] * (ROWS - 1)]
    table["list"] = list(np.stack([TORQUE, 2 * TORQUE], axis=1))
    table["ragged"] = [[1.0, 2.0, 3.0], [1.0], *[[1.0, 2.0]] * (ROWS - 2)]
    table.to_parquet(path)
    found = read_columns(path, path.name, ["i", 2, "b", "lost"])
    assert [values.dtype.name for values in found.values()] == ["int32", "float32", "uint8", "float64"]
    assert found["i"].tolist() == COUNTS.tolist()
    assert np.flatnonzero(np.isnan(found["lost"])).tolist() == [0]
    assert read_columns(path, path.name, ["list[2]"])["list[2]"].tolist() == (2 * TORQUE).tolist()
    refused = {"dec": "decimal128", "when": "1 rows without a time", "x": "'x', as the map says"}
    for name, message in (refused | {"ragged[1]": "lists of different lengths"}).items():
        with pytest.raises(FileDefect, match=rf"a\.parquet.*{message}"):
            read_columns(path, path.name, [name])


def test_json_lines_have_members_lists_and_stamps(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    samples = [
        {
            "at": f"2026-03-12T10:22:{row:02d}Z",
            "m": {"t": None if row == 3 else row / 2},
            "q": [row, 2 * row],
            "n": ["a"],
        }
        for row in range(16)
    ]
    path.write_text("\n".join(map(json.dumps, samples)), encoding="utf-8")
    found = read_columns(path, path.name, ["at", "m.t", "q[2]"])
    assert (found["at"] - found["at"][0]).tolist() == [row * 10**9 for row in range(16)]
    np.testing.assert_array_equal(found["m.t"], [np.nan if row == 3 else row / 2 for row in range(16)])
    assert found["q[2]"].tolist() == [2 * row for row in range(16)]
    with pytest.raises(FileDefect, match=r"a\.jsonl, column n: found 'text' .* expected real numbers"):
        read_columns(path, path.name, ["n"])
    for text, message in (('{"a": 1}\n[1]', "row 2: found a list"), ('{"a": 1', "row 1: found no JSON")):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(FileDefect, match=message):
            read_columns(path, path.name, ["a"])


def test_cells_of_a_spreadsheet_are_plain_values(tmp_path: Path, reader: LimitedReader) -> None:
    book = openpyxl.Workbook()
    page = book.create_sheet("run 1")
    for row in (["t", "q"], [], [1, 2.5, None], [datetime.datetime(2024, 2, 29, 12), "=A1"], [True, "#N/A"], [None]):
        page.append(row)
    book.save(tmp_path / "a.xlsx")
    expected = [["t", "q"], [], [1, 2.5], ["2024-02-29T12:00:00"], [True, "#N/A"]]
    assert cells(tmp_path / "a.xlsx", "a.xlsx", "run 1", reader) == expected
    assert cells(tmp_path / "a.xlsx", "a.xlsx", 2) == expected
    assert cells(tmp_path / "a.xlsx", "a.xlsx", 1) == []
    for sheet in (None, "run 2"):
        with pytest.raises(FileDefect, match="the sheets 'Sheet', 'run 1', expected one of them: set sheet in a map"):
            cells(tmp_path / "a.xlsx", "a.xlsx", sheet, reader)
    (tmp_path / "a.xls").write_bytes(b"")
    with pytest.raises(FileDefect, match="save the spreadsheet in this format"):
        cells(tmp_path / "a.xls", "a.xls")
    assert is_spreadsheet(Path("A.XLSX"))
    assert not is_binary(Path("a.xlsx"))


def with_rows(path: Path, rows: str) -> None:
    """A spreadsheet whose sheet is any text."""
    openpyxl.Workbook().save(path)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    space = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    members["xl/worksheets/sheet1.xml"] = f'<worksheet xmlns="{space}">{rows}</worksheet>'.encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)


SHEETS = {
    "a row far below": '<sheetData><row r="2000000000"><c r="A2000000000"><v>1</v></c></row></sheetData>',
    "very many cells": "<sheetData>" + "<row>" + "<c><v>1</v></c>" * 300_000 + "</row></sheetData>",
}


@pytest.mark.parametrize("name", list(SHEETS))
def test_a_bomb_of_cells_is_refused(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limited, "OWN_MEMORY", 2**24)
    monkeypatch.setattr(limits, "ALWAYS_EXPANDED", 2**20)
    with_rows(tmp_path / "a.xlsx", SHEETS[name])
    with pytest.raises(FileDefect, match=r"^a\.xlsx.*(more cells or rows|more than)"):
        cells(tmp_path / "a.xlsx", "a.xlsx")


@pytest.mark.parametrize("claimed", ["A1", "A1:XFD1048576"])
def test_a_claimed_size_is_not_believed(tmp_path: Path, reader: LimitedReader, claimed: str) -> None:
    row = '<row r="1"><c r="A1"><v>1</v></c><c r="B1"><v>2</v></c></row>'  # other programs claim A1 and write more
    with_rows(tmp_path / "a.xlsx", f'<dimension ref="{claimed}"/><sheetData>{row}</sheetData>')
    assert cells(tmp_path / "a.xlsx", "a.xlsx", None, reader) == [[1, 2]]


@pytest.mark.parametrize("ending", sorted({*IN_CHILD, ".xlsx", ".h5", ".parquet"}))
def test_what_is_no_such_file_is_named(tmp_path: Path, reader: LimitedReader, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    for content in (b"", b"t,q\n1,2\n", bytes(range(256)) * 20):
        path.write_bytes(content)
        with pytest.raises(FileDefect, match=rf"^a\{ending}"):
            cells(path, path.name, None, reader) if ending == ".xlsx" else read_columns(path, path.name, ["q"], reader)


def test_an_absent_library_is_named_with_the_way_to_install_it(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "nptdms.py").write_text("raise ModuleNotFoundError('no', name='nptdms')")
    monkeypatch.syspath_prepend(str(tmp_path))
    message = r"\.tdms, which needs the library nptdms.*pip install 'swg-workbench\[formats\]'"
    with pytest.raises(FileDefect, match=message):
        read_columns(folder / "a.tdms", "a.tdms", ["n"])
