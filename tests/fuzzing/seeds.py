"""Sound files to begin with, made by the project's own writers or by the libraries that others use."""

from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import yaml
from scipy.io import savemat
from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
from sklearn.neural_network import MLPClassifier

from learn.evaluation import models
from learn.methods import neural
from swgsim.bench.truth import write_sealed
from swgsim.effects import text
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.files.recording_file import write_file
from swgsim.recordings.recording import Recording
from swgsim.storage import storage
from swgsim.storage.labelled_signals import COLUMNS, LabelledSignals, facts

CONF = Path(__file__).parents[2] / "conf" / "sources"
ROWS = 24
COLUMNS_OF_MODELS, CLASSES = 10, ("healthy", "root", "tip")


def recording(number: int) -> Recording:
    """A short one with every channel."""
    rng = np.random.default_rng(number)
    point = OperatingPoint(2000, 39.5)
    time = np.arange(ROWS) / 3000
    phi = 0.1 * number + point.omega_in * time
    gauges = {f"s{i}": 0.06 + 0.17 * np.cos(2 * phi - np.pi * i) + 1e-3 * rng.normal(size=ROWS) for i in range(5)}
    others = {"n_in": 2000 + rng.normal(size=ROWS), "T_in": np.full(ROWS, 0.5), "T_out": 39.5 + rng.normal(size=ROWS)}
    return Recording(
        f"run {number}",
        "A17",
        "monday",
        point,
        number,
        time,
        {"phi_in": phi, **others, **gauges},
        Conditions(24.5, 60.0),
    )


GOOD = (recording(1), recording(2))


def folder(place: Path) -> None:
    write_folder(place / "bench", GOOD)


def one_file(place: Path) -> None:
    write_file(place / "bench.h5", GOOD)


def columns(number: int) -> dict[str, np.ndarray]:
    """Of a foreign file, as conf/sources/example.yaml names them."""
    one = recording(number)
    angle = np.degrees(one.channels["phi_in"])
    names = ("Speed", "TorqueIn", "TorqueOut", *(f"Bridge{i}" for i in range(5)))
    return {
        "Time": 1e3 * one.time,
        "EncoderAngle": angle,
        **dict(zip(names, list(one.channels.values())[1:], strict=True)),
    }


def mapped(place: Path, ending: str) -> Path:
    """The map, and where a file for it is to be written."""
    config = yaml.safe_load((CONF / "example.yaml").read_text(encoding="utf-8"))
    config["files"] = {f"run1.{ending}": {"n_in_rpm": 2000, "T_out_nm": 39, "repeat": 1}}
    (place / "map.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    (place / "files").mkdir()
    return place / "files" / f"run1.{ending}"


def foreign_csv(place: Path) -> None:
    pd.DataFrame(columns(1)).to_csv(mapped(place, "csv"), index=False)


def matlab(place: Path, compressed: bool) -> None:
    savemat(mapped(place, "mat"), columns(1), do_compression=compressed)


def matlab_73(place: Path) -> None:
    with h5py.File(mapped(place, "mat"), "w", userblock_size=512) as file:
        for name, values in columns(1).items():
            file.create_dataset(name, data=values[None], compression="gzip")


def parquet(place: Path, compression: str | None) -> None:
    pd.DataFrame(columns(1)).to_parquet(mapped(place, "parquet"), compression=compression)


def joints(place: Path, ending: str) -> None:
    """A folder for conf/sources/kinova_gen3.yaml, and a copy of that."""
    from fabricated_joints import write_file as write_table

    (place / "source.yaml").write_bytes((CONF / "kinova_gen3.yaml").read_bytes())
    rng, time = np.random.default_rng(0), np.arange(700) / 880
    table = {"position_rad": (6 + 0.5 * time) % (2 * np.pi), "velocity_rad_s": 0.5 + 0.01 * rng.normal(size=700),
             "torque_sensor_Nm": rng.normal(size=700), "current_A": rng.normal(size=700)}  # fmt: skip
    write_table(place / "files" / f"S1_x_v0.50.{ending}", pd.DataFrame(table).to_csv(index=False).encode())


def data_set(place: Path) -> None:
    rows = {name: [1, 1] for name in COLUMNS} | {"label": ["healthy", "root_tooth_crack"]}
    signals = np.random.default_rng(0).normal(size=(2, 5, 32)).astype("f4")
    storage.write(
        place / "set.h5", [LabelledSignals(signals, facts(rows), 1e4, {"configuration": "a: 1", "swgsim": "1"})], 2
    )


def task() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    y = np.array(CLASSES)[np.arange(30) % 3]
    return rng.normal(size=(30, COLUMNS_OF_MODELS)) + (np.arange(30) % 3)[:, None], y


def network(place: Path) -> None:
    models.save(neural.neural_perceptron(neurons=8, epochs=1, device="cpu").fit(*task()), place / "model.pt")


def forest(place: Path) -> None:
    models.save(RandomForestClassifier(3, max_depth=3, random_state=0).fit(*task()), place / "model.skops")


def boosted(place: Path) -> None:
    models.save(HistGradientBoostingClassifier(max_iter=2, min_samples_leaf=2).fit(*task()), place / "model.skops")


def perceptron(place: Path) -> None:
    from sklearn.utils._testing import ignore_warnings

    model = ignore_warnings(MLPClassifier((4,), max_iter=2, random_state=0).fit)(*task())
    models.save(model, place / "model.skops")


def effects(place: Path) -> None:
    made = text.from_entries([{"eccentric_wave_generator": {"r": 1e-5, "theta": 1.0}}])
    (place / "effects.yaml").write_text(text.as_text(made))


def truth(place: Path) -> None:
    told = {"salt": "0", "hidden": [{"eccentric_wave_generator": {"r": 1e-5}}]}
    write_sealed(place / "bench", GOOD[:1], {"gear.yaml": "a: 1\n"}, told)
