"""The one file: round trip, xarray, damage."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray
from chain_fixtures import small_plan

from swgsim.dataset.simulate_cases import record
from swgsim.storage import storage
from swgsim.storage.labelled_signals import COLUMNS, LabelledSignals, facts


@pytest.fixture(scope="module")
def recordings() -> LabelledSignals:
    plan = small_plan()
    return record(plan, next(plan.blocks())[:6])


@pytest.fixture(scope="module")
def path(recordings: LabelledSignals, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("file") / "recordings.h5"
    storage.write(path, [recordings.where(np.arange(4)), recordings.where(np.arange(4, 6))], 6)
    return path


def test_round_trip(path: Path, recordings: LabelledSignals) -> None:
    read = storage.read(path)
    np.testing.assert_array_equal(read.signals, recordings.signals)
    assert read.table.equals(recordings.table)
    assert read.rate == recordings.rate
    assert read.attributes["configuration"] == recordings.attributes["configuration"]
    assert "swgsim" in read.attributes


def test_blocks_hold_the_same_rows(path: Path, recordings: LabelledSignals) -> None:
    blocks = list(storage.blocks(path, 4))
    assert [len(b) for b in blocks] == [4, 2]
    np.testing.assert_array_equal(np.concatenate([b.signals for b in blocks]), recordings.signals)


def test_xarray_opens_it_with_units(path: Path) -> None:
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        assert data["signals"].dims == ("sample", "sensor", "time")
        assert data["signals"].attrs["units"] == "mV/V"
        assert list(data["sensor"].values) == ["s0", "s1", "s2", "s3", "s4"]
        assert "root_tooth_crack" in data["label"].attrs["flag_meanings"]
        names = data["label"].attrs["flag_meanings"].split()
        assert [names[code] for code in data["label"].values] == list(data["label_name"].values)
        assert data.where(data.label_name == "healthy", drop=True).sizes["sample"] == 6


def test_any_changed_byte_is_noticed(path: Path, tmp_path: Path) -> None:
    """Those of the seal, and some of the rest."""
    content, damaged = path.read_bytes(), tmp_path / "damaged.h5"
    for where in (*range(storage.SEAL_SIZE), *range(storage.SEAL_SIZE, len(content), len(content) // 100)):
        changed = bytearray(content)
        changed[where] ^= 1 << where % 8
        damaged.write_bytes(changed)
        with pytest.raises(ValueError, match=r"damaged\.h5"):
            storage.read(damaged)


@pytest.mark.parametrize("size", [0, 100, 512, 5000])
def test_a_truncated_file_is_named(path: Path, tmp_path: Path, size: int) -> None:
    short = tmp_path / "short.h5"
    short.write_bytes(path.read_bytes()[:size])
    with pytest.raises(ValueError, match=r"short\.h5"):
        storage.read(short)


def test_nothing_is_left_of_a_failed_write(tmp_path: Path, recordings: LabelledSignals) -> None:
    with pytest.raises(ValueError, match="6 recordings found, 7 announced"):
        storage.write(tmp_path / "a.h5", [recordings], 7)
    with pytest.raises(ValueError, match="more than the 5 recordings"):
        storage.write(tmp_path / "a.h5", [recordings], 5)
    assert not list(tmp_path.iterdir())


def test_what_a_killed_write_left_is_replaced(tmp_path: Path, path: Path, recordings: LabelledSignals) -> None:
    again = tmp_path / "a.h5"
    (tmp_path / ".a.h5.tmp").write_bytes(path.read_bytes()[:5000])
    storage.write(again, [recordings.where(np.arange(4)), recordings.where(np.arange(4, 6))], 6)
    assert list(tmp_path.iterdir()) == [again]
    assert again.read_bytes() == path.read_bytes()


def test_signals_that_are_no_numbers_are_named(recordings: LabelledSignals) -> None:
    signals = recordings.signals.copy()
    signals[2, 3, 17] = np.nan
    with pytest.raises(ValueError, match="recording 2, s3, sample 17: found nan, expected a finite number"):
        LabelledSignals(signals, recordings.table, recordings.rate)


def test_what_a_file_says_of_itself_has_a_length(tmp_path: Path, recordings: LabelledSignals) -> None:
    said = {"configuration": "größe: 1\n", "empty": ""}
    storage.write(tmp_path / "a.h5", [replace(recordings, attributes=said)], 6)
    assert said.items() <= storage.attributes(tmp_path / "a.h5").items()
    with pytest.raises(ValueError, match="configuration has 64001 bytes, an attribute holds at most 64000"):
        storage.write(tmp_path / "b.h5", [replace(recordings, attributes={"configuration": 64_001 * "x"})], 6)


def test_facts_must_fit(recordings: LabelledSignals) -> None:
    with pytest.raises(ValueError, match="one row each"):
        LabelledSignals(recordings.signals[:3], recordings.table, recordings.rate)
    rows = {name: [0] for name in COLUMNS} | {"label": ["rusty"]}
    with pytest.raises(ValueError, match="unknown choice 'rusty' of label; choose from healthy"):
        facts(rows)
    del rows["seed"]
    with pytest.raises(ValueError, match="columns"):
        facts(rows)
