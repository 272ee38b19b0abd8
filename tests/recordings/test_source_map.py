"""Column maps: a bad one is named, a good one is followed in all its entries."""

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_fixtures import EXAMPLE_MAP, SHORT, assert_sound, mapped

from swgsim.recordings.files import facts
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.tables.file_defect import FileDefect


def test_a_sampling_rate_replaces_the_time(tmp_path: Path) -> None:
    channels = {"s1": {"column": "Bridge1", "unit": "V/V"}}
    folder, path = mapped(tmp_path, "plain.parquet", channels=channels, sampling_rate_hz=3000)
    (found,) = read_mapped(folder, read_map(path))
    np.testing.assert_allclose(found.time, SHORT[0].time)
    assert list(found.channels) == ["s1"]


BAD_MAPS: dict[str, tuple[dict[str, object], str]] = {
    "unknown entry": ({"chanels": {}}, "unknown choice 'chanels' of the column map"),
    "unknown channel": ({"channels": {"s9": {"column": "a", "unit": "V/V"}}}, "unknown choice 's9' of channels"),
    "unknown unit": ({"channels": {"s1": {"column": "a", "unit": "bar"}}}, "unknown choice 'bar' of the unit of s1"),
    "unit of another quantity": ({"channels": {"t": {"column": "a", "unit": "rad"}}}, "unknown choice 'rad'"),
    "no unit": ({"channels": {"s1": {"column": "a"}}}, "unit of channel s1 is 'None'"),
    "strain without a bridge": ({"channels": {"s1": {"column": "a", "unit": "um/m"}}}, "gauge_factor and active_arms"),
    "arms that are not a number": (
        {"channels": {"s1": {"column": "a", "unit": "um/m", "gauge_factor": 2.0, "active_arms": True}}},
        "active_arms of s1 is True, must be one of 1, 2, 4",
    ),
    "no time": ({"channels": {"s1": {"column": "a", "unit": "V/V"}}}, "either the channel t or sampling_rate_hz"),
    "time twice": ({"sampling_rate_hz": 1000}, "either the channel t or sampling_rate_hz"),
    "zero of a gauge": ({"channels": {"s1": {"column": "a", "unit": "V/V", "zero_rad": 0.1}}}, "only phi_in has one"),
    "zero beyond a turn": (
        {"channels": {"phi_in": {"column": "a", "unit": "deg", "zero_rad": 34.4}}}, "zero_rad of phi_in is 34.4",
    ),
    "channels are a list": ({"channels": [1]}, "channels is '\\[1\\]', must be names with values"),
    "missing column": (
        {"channels": {"t": {"column": "Clock", "unit": "s"}}},
        "run1.csv, row 1: found the columns 'Time'.*expected 'Clock', as the map says",
    ),
    "unknown fact": ({"facts": {"gear": "A", "session": "b", "weather": 1}}, "unknown fact 'weather'"),
    "no gear": ({"facts": {"session": "b"}}, "found no gear"),
    "file without entry": ({"files": {"run1.csv": {}}}, "run2.csv: found no entry for this file"),
    "entry outside": (
        {"files": {"run1.csv": {}, "run2.csv": {}, "../a.mat": {}}}, "found no n_in_rpm|'../a.mat', expected the name",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", list(BAD_MAPS))
def test_a_bad_map_is_named(tmp_path: Path, name: str) -> None:
    changes, message = BAD_MAPS[name]
    folder, path = mapped(tmp_path, "x.csv", SHORT, **changes)
    with pytest.raises(FileDefect, match=message):
        read_mapped(folder, read_map(path))


CONFIG = yaml.safe_load(EXAMPLE_MAP.read_text(encoding="utf-8"))
CONFIG["files"] = {"run1.csv": {"n_in_rpm": 2000, "T_out_nm": 39, "repeat": 1}}
KEYS = ("column", "unit", "inverted", "gauge_factor", "active_arms", "zero_rad", "colour")
PLACES = [
    (),
    *((name,) for name in (*CONFIG, "sampling_rate_hz", "chanels")),
    *(("channels", name) for name in (*CONFIG["channels"], "s9")),
    *(("channels", name, key) for name in ("t", "phi_in", "s0", "s2") for key in KEYS),
    *(("facts", name) for name in (*facts.KNOWN, "weather")),
    *(("files", name) for name in ("run1.csv", "run2.csv", "../run1.csv")),
    *(("files", "run1.csv", name) for name in (*facts.KNOWN, "weather")),
]
PLAIN = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
ANYTHING = PLAIN | st.lists(PLAIN, max_size=3) | st.dictionaries(st.text(max_size=8), PLAIN, max_size=3)
ENTRIES = ANYTHING | st.sampled_from(["Time", "Bridge0", "ms", "rad", "um/m", "mV/V", "17", "1e3", 1, 2, 4, 0.5, 2.0])


def entered(place: tuple[str, ...], entry: Any) -> dict | Any:
    """The map with another entry at a place."""
    if not place:
        return entry
    config = inner = deepcopy(CONFIG)
    for name in place[:-1]:
        inner = inner[name]
    inner[place[-1]] = entry
    return config


@pytest.fixture(scope="module")
def csv(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return mapped(tmp_path_factory.mktemp("map"), "x.csv")


@settings(deadline=None, derandomize=True, max_examples=100)
@given(st.builds(entered, st.sampled_from(PLACES), ENTRIES))
def test_a_map_is_named_or_followed_in_all_its_entries(csv: tuple[Path, Path], config: Any) -> None:
    folder, path = csv
    path.write_text(yaml.safe_dump(config))
    try:
        source = read_map(path)
        (found,) = read_mapped(folder, source)
    except FileDefect:
        return
    given = yaml.safe_load(path.read_text())
    assert {each.channel for each in source.channels} == set(given["channels"])
    assert {"t", *found.channels} == {"t", *given["channels"]}
    for each in source.channels:
        assert {key: getattr(each, key) for key in given["channels"][each.channel]} == given["channels"][each.channel]
    assert source.sampling_rate_hz == given.get("sampling_rate_hz")
    known = facts.of(found)
    for name, value in {**given.get("facts", {}), **given.get("files", {}).get("run1.csv", {})}.items():
        assert known[name] == (str(value) if isinstance(known[name], str) else float(value))
    assert_sound(found)
