"""Files of others and their column map, spoiled as hypothesis draws it: named, or read as what they say."""

import subprocess
import sys
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import yaml
from fuzzing import seeds
from hypothesis import given, settings
from hypothesis import strategies as st
from test_joint_intake import PLAIN as ANYTHING

from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.files import facts
from swgsim.recordings.files.assembly import column_of
from swgsim.recordings.files.file_defect import FileDefect
from swgsim.recordings.files.limits import LARGEST_NUMBER, SMALLEST_STEP
from swgsim.recordings.files.source_map import SourceMap, read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.recordings.recording import Recording

# A warning stops nothing where a reader is used, and so not here.
pytestmark = pytest.mark.filterwarnings("ignore")
FUZZ = settings(deadline=None, derandomize=True)

WRITERS = {
    "v5.mat": partial(seeds.matlab, compressed=False),
    "v5 compressed.mat": partial(seeds.matlab, compressed=True),
    "v73.mat": seeds.matlab_73,
    "plain.parquet": partial(seeds.parquet, compression=None),
    "snappy.parquet": partial(seeds.parquet, compression="snappy"),
}
SUMMED = "v5 compressed.mat"  # every byte of a number is under a sum, so that no other number can be there unseen
AS_IN_MEMORY = ("v5.mat", "plain.parquet")  # numbers lie in the file as they are in the memory


class Sound(NamedTuple):
    """A file, its map, and what is read of them."""

    form: str
    file: Path
    content: bytes
    map: Path
    source: SourceMap
    recording: Recording

    def read(self) -> Recording | FileDefect:
        """What is read of the file as it is now, or why it is refused."""
        try:
            (found,) = read_mapped(self.file.parent, self.source)
        except FileDefect as refusal:
            return refusal
        return found


def made(place: Path, form: str) -> Sound:
    WRITERS[form](place)
    (file,) = (place / "files").iterdir()
    source = read_map(place / "map.yaml")
    (recording,) = read_mapped(file.parent, source)
    return Sound(form, file, file.read_bytes(), place / "map.yaml", source, recording)


@pytest.fixture(scope="module", params=list(WRITERS))
def sound(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Sound:
    return made(tmp_path_factory.mktemp("foreign"), request.param)


@pytest.fixture(scope="module", params=AS_IN_MEMORY)
def plain(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Sound:
    return made(tmp_path_factory.mktemp("plain"), request.param)


@pytest.fixture(scope="module")
def mapped(tmp_path_factory: pytest.TempPathFactory) -> Sound:
    return made(tmp_path_factory.mktemp("mapped"), "v5.mat")


def arrays(recording: Recording) -> dict[str, np.ndarray]:
    return {"t": recording.time, **recording.channels}


def assert_sound(found: Recording) -> None:
    """Numbers that can be computed with and inspected."""
    assert all(np.isfinite(values).all() for values in arrays(found).values())
    assert (np.diff(found.time) > 0).all()
    inspect((found,))


# The bytes of a file.


@settings(FUZZ, max_examples=150)
@given(data=st.data())
def test_damage_is_named_or_leaves_a_sound_recording(sound: Sound, data: st.DataObject) -> None:
    """Bytes are others and the end is missing; without a sum nobody knows whether a plausible number was another."""
    where = st.integers(0, len(sound.content) - 1)
    changes = data.draw(st.dictionaries(where, st.integers(0, 255), max_size=4))
    kept = data.draw(st.just(len(sound.content)) | where)
    raw = bytearray(sound.content)
    for at, byte in changes.items():
        raw[at] = byte
    sound.file.write_bytes(raw[:kept])
    found = sound.read()
    if isinstance(found, FileDefect):
        assert found.file == sound.file.name
        assert raw[:kept] != sound.content
        return
    assert_sound(found)
    assert facts.of(found) == facts.of(sound.recording)
    assert list(found.channels) == list(sound.recording.channels)
    assert len(found.time) == seeds.ROWS
    if sound.form == SUMMED or raw[:kept] == sound.content:
        for name, values in arrays(sound.recording).items():
            np.testing.assert_array_equal(arrays(found)[name], values)


@settings(FUZZ, max_examples=150)
@given(
    column=st.sampled_from([name for name in seeds.columns(1) if name not in ("EncoderAngle", "TorqueIn")]),
    row=st.integers(0, seeds.ROWS - 1),
    raw=st.binary(min_size=8, max_size=8) | st.floats(width=64).map(lambda value: np.float64(value).tobytes()),
)
def test_other_bytes_of_a_number_are_that_number_and_no_other(plain: Sound, column: str, row: int, raw: bytes) -> None:
    """It is read as it is, or named with its row and column where nothing can be computed with it. Not the angle, which
    is unwrapped, nor a torque that is constant, which Parquet keeps once.
    """
    columns = seeds.columns(1)
    where = plain.content.index(columns[column].tobytes()) + 8 * row
    plain.file.write_bytes(plain.content[:where] + raw + plain.content[where + 8 :])
    (source,) = (each for each in plain.source.channels if each.column == column)
    columns[column][row] = np.frombuffer(raw)[0]
    expected = arrays(plain.recording) | {source.channel: source.values(columns[column])}
    usable = (np.abs(expected[source.channel]) <= LARGEST_NUMBER).all()
    usable = usable and (np.diff(expected["t"]) >= SMALLEST_STEP).all()
    found = plain.read()
    if isinstance(found, FileDefect):
        assert not usable
        assert (found.file, found.column) == (plain.file.name, column_of(source.channel))
        assert found.row in (row + 2, row + 3)  # a time may be out of order only against the next
        return
    assert usable
    for name, values in expected.items():
        np.testing.assert_array_equal(arrays(found)[name], values)


def test_a_type_that_no_number_has_is_named(tmp_path: Path) -> None:
    """In a process of its own, which must not end by a signal; type 8 is reserved."""
    sound = made(tmp_path, "v5.mat")
    where = sound.content.index(seeds.columns(1)["Time"].tobytes()) - 8
    sound.file.write_bytes(sound.content[:where] + b"\x08" + sound.content[where + 1 :])
    program = (
        "import sys\nfrom pathlib import Path\nfrom swgsim.recordings.files.foreign import read_columns\n"
        "read_columns(Path(sys.argv[1]), 'a.mat', ['Time'])"
    )
    done = subprocess.run([sys.executable, "-c", program, sound.file], capture_output=True, text=True, check=False)
    assert "FileDefect: a.mat" in done.stderr


# The column map.

CONFIG = yaml.safe_load((seeds.CONF / "example.yaml").read_text(encoding="utf-8"))
CONFIG["files"] = {"run1.mat": {"n_in_rpm": 2000, "T_out_nm": 39, "repeat": 1}}
TEXT = yaml.safe_dump(CONFIG).encode()
PLACES = [
    (),
    *((name,) for name in (*CONFIG, "sampling_rate_hz", "chanels")),
    *(("channels", name) for name in (*CONFIG["channels"], "s9")),
    *(("channels", name, key) for name in ("t", "phi_in", "s0", "s2")
      for key in ("column", "unit", "inverted", "gauge_factor", "active_arms", "zero_rad", "colour")),
    *(("facts", name) for name in (*facts.KNOWN, "weather")),
    *(("files", name) for name in ("run1.mat", "run2.mat", "../run1.mat")),
    *(("files", "run1.mat", name) for name in (*facts.KNOWN, "weather")),
]  # fmt: skip
ENTRIES = ANYTHING | st.sampled_from(["Time", "Bridge0", "ms", "rad", "um/m", "mV/V", "17", "1e3", 1, 2, 4, 0.5, 2.0])


def entered(place: tuple[str, ...], entry: Any) -> bytes:
    """The map with another entry at a place."""
    if not place:
        return yaml.safe_dump(entry).encode()
    config = inner = deepcopy(CONFIG)
    *above, last = place
    for name in above:
        inner = inner[name]
    inner[last] = entry
    return yaml.safe_dump(config).encode()


def edited(at: float, removed: int, put: bytes) -> bytes:
    """The text of the map with other characters at a place."""
    where = int(at * len(TEXT))
    return TEXT[:where] + put + TEXT[where + removed :]


@settings(FUZZ, max_examples=250)
@given(
    st.builds(entered, st.sampled_from(PLACES), ENTRIES)
    | st.builds(
        edited, st.floats(0, 1, exclude_max=True), st.integers(0, 30),
        st.binary(max_size=12) | st.text("0123456789.e-:,{}[]&*!#'\n \tsrad", max_size=12).map(str.encode),
    )
)  # fmt: skip
def test_a_map_is_named_or_taken_with_all_that_it_says(mapped: Sound, text: bytes) -> None:
    mapped.map.write_bytes(text)
    try:
        source = read_map(mapped.map)
        (found,) = read_mapped(mapped.file.parent, source)
    except FileDefect:
        return
    said = yaml.safe_load(text)
    assert {each.channel for each in source.channels} == set(said["channels"])
    assert set(arrays(found)) == {"t", *said["channels"]}
    for each in source.channels:
        assert {key: getattr(each, key) for key in said["channels"][each.channel]} == said["channels"][each.channel]
    assert source.sampling_rate_hz == said.get("sampling_rate_hz")
    taken = facts.of(found)
    for name, value in {**said.get("facts", {}), **said.get("files", {}).get("run1.mat", {})}.items():
        assert taken[name] == (str(value) if isinstance(taken[name], str) else float(value))
    assert_sound(found)
