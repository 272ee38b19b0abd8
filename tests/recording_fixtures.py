"""LabelledSignals made up by formula, and sound files of every format, for tests that spoil them."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import yaml
from scipy.io import savemat

from swgsim.bench.truth import write_sealed
from swgsim.effects.eccentric_wave_generator import EccentricWaveGenerator
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.model import Model
from swgsim.identification.fit.unit import Unit
from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.files.recording_file import write_file
from swgsim.recordings.recording import Recording
from swgsim.storage import storage
from swgsim.storage.labelled_signals import COLUMNS, LabelledSignals, facts
from swgsim.storage.storage import SEAL_SIZE, SEAL_START

EXAMPLE_MAP = Path(__file__).parents[1] / "conf" / "sources" / "example.yaml"
ROWS = 24
CLASSES = ("healthy", "root", "tip")


def recording(number: int, rows: int = ROWS, **changes: object) -> Recording:
    """Every channel, with the symmetry of a healthy gear."""
    rng = np.random.default_rng(number)
    point = OperatingPoint(2000, 39.5)
    time = np.arange(rows) / 3000
    phi = 0.1 * number + point.omega_in * time
    channels = {
        "phi_in": phi,
        "n_in": 2000 + rng.normal(size=rows),
        "T_in": 0.5 + 0.01 * rng.normal(size=rows),
        "T_out": 39.5 + rng.normal(size=rows),
        "s0": 0.13 + 0.01 * np.cos(4 * phi) + 1e-3 * rng.normal(size=rows),
        **{f"s{i}": 0.06 + 0.17 * np.cos(2 * phi - np.pi * i) + 1e-3 * rng.normal(size=rows) for i in range(1, 5)},
    }
    made = Recording(f"run {number}", "A, 17", "monday", point, number, time, channels, Conditions(24.5, 60.0))
    return replace(made, **changes)


SHORT = (recording(1), recording(2))


def assert_same(found: Sequence[Recording], expected: Sequence[Recording]) -> None:
    """Every fact and every number, exactly."""
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one.time, other.time)
        assert list(one.channels) == list(other.channels)
        for name in other.channels:
            np.testing.assert_array_equal(one.channels[name], other.channels[name])
        assert replace(one, time=other.time, channels={}) == replace(other, channels={})


def assert_sound(found: Recording) -> None:
    """Finite numbers and an increasing time, which the checks accept as input."""
    assert all(np.isfinite(values).all() for values in (found.time, *found.channels.values()))
    assert (np.diff(found.time) > 0).all()
    inspect((found,))


# Files of other formats, with the columns and units of the example map.

TO_FOREIGN: dict[str, Callable[[Recording], np.ndarray]] = {
    "Time": lambda r: 1e3 * r.time,
    "EncoderAngle": lambda r: np.degrees(r.channels["phi_in"]) % 360,
    "Speed": lambda r: r.channels["n_in"] * 2 * np.pi / 60,
    "TorqueIn": lambda r: 1e3 * r.channels["T_in"],
    "TorqueOut": lambda r: r.channels["T_out"],
    "Bridge0": lambda r: r.channels["s0"] / 0.002,
    "Bridge1": lambda r: 1e-3 * r.channels["s1"],
    "Bridge2": lambda r: -1e-3 * r.channels["s2"],
    "Bridge3": lambda r: 1e-3 * r.channels["s3"],
    "Bridge4": lambda r: 1e-3 * r.channels["s4"],
}


def columns(one: Recording = SHORT[0]) -> dict[str, np.ndarray]:
    return {column: np.array(make(one)) for column, make in TO_FOREIGN.items()}


def save_v73(path: Path, table: dict) -> None:
    """As MATLAB does: HDF5 with transposed rows, behind a block of 512 bytes."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in table.items():
            file.create_dataset(name, data=values[None], compression="gzip")


def save_parquet(path: Path, table: dict, compression: str | None = None) -> None:
    pd.DataFrame(table).to_parquet(path, compression=compression)


def save_csv(path: Path, table: dict) -> None:
    pd.DataFrame(table).to_csv(path, index=False)


SAVERS: dict[str, Callable[[Path, dict], None]] = {
    "v4.mat": partial(savemat, format="4"),
    "v5.mat": savemat,
    "v5 compressed.mat": partial(savemat, do_compression=True),
    "v73.mat": save_v73,
    "plain.parquet": save_parquet,
    "snappy.parquet": partial(save_parquet, compression="snappy"),
    "x.csv": save_csv,
}


def mapped(
    place: Path, saver: str, recordings: Sequence[Recording] = SHORT[:1], **changes: object
) -> tuple[Path, Path]:
    """A folder with a file of each recording, and the example map for them."""
    folder = place / "files"
    folder.mkdir(parents=True)
    config = yaml.safe_load(EXAMPLE_MAP.read_text(encoding="utf-8"))
    config["files"] = {}
    for number, each in enumerate(recordings, 1):
        name = f"run{number}.{saver.split('.')[1]}"
        SAVERS[saver](folder / name, columns(each))
        config["files"][name] = {"n_in_rpm": 2000, "T_out_nm": 39.5, "repeat": number}
    (place / "map.yaml").write_text(yaml.safe_dump({**config, **changes}))
    return folder, place / "map.yaml"


# Files of the workbench.


def sealed(body: bytes, start: bytes = SEAL_START) -> bytes:
    """Any bytes with the seal of :mod:`swgsim.storage.storage`, which anybody can write."""
    return (start + hashlib.sha256(body).hexdigest().encode() + b"\n").ljust(SEAL_SIZE, b" ") + body


def bench_folder(place: Path) -> None:
    write_folder(place / "bench", SHORT)


def bench_file(place: Path) -> None:
    write_file(place / "bench.h5", SHORT)


def unit_file(place: Path) -> None:
    scatter = Scatter({"load": 0.01}, 4, np.eye(1))
    model = Model(Gear(), (EccentricWaveGenerator(1e-5, 1.0),))
    Unit(model, np.eye(3), scatter=scatter, largest={"s1": 0.1}, healthy=SHORT[:1]).save(place / "gear.unit.h5")


def data_set(place: Path) -> None:
    rows = {name: [1, 1] for name in COLUMNS} | {"label": ["healthy", "root_tooth_crack"]}
    signals = np.random.default_rng(0).normal(size=(2, 5, 32)).astype("f4")
    attributes = {"configuration": "a: 1", "swgsim": "1"}
    storage.write(place / "set.h5", [LabelledSignals(signals, facts(rows), 1e4, attributes)], 2)


def truth(place: Path) -> None:
    hidden = {"salt": "0", "hidden": [{"eccentric_wave_generator": {"r": 1e-5}}]}
    write_sealed(place / "bench", SHORT[:1], {"gear.yaml": "a: 1\n"}, hidden)


def training_rows() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    return rng.normal(size=(30, 10)) + (np.arange(30) % 3)[:, None], np.array(CLASSES)[np.arange(30) % 3]


def network(place: Path) -> None:
    from learn.evaluation import models
    from learn.methods import neural

    models.save(neural.neural_perceptron(neurons=8, epochs=1, device="cpu").fit(*training_rows()), place / "model.pt")


def forest(place: Path) -> None:
    from sklearn.ensemble import RandomForestClassifier

    from learn.evaluation import models

    models.save(RandomForestClassifier(3, max_depth=3, random_state=0).fit(*training_rows()), place / "model.skops")
