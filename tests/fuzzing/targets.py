"""Every reader with its sound files, what of them is spoiled and how, and what an accepted reading must be."""

import hashlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fuzzing import seeds
from fuzzing.mutation import BINARY, TEXT, Way
from fuzzing.wrapping import GZIPPED, PLAIN, SEALED, ZIPPED, Wrapping
from learn.evaluation import models
from swgsim.bench.truth import SEAL
from swgsim.effects import text
from swgsim.identification.report.close_loop import _hidden
from swgsim.joint.intake.read import read_joints
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.storage import storage


class Target(NamedTuple):
    """A reader.

    ``write`` makes sound files in a folder, of which one that matches ``spoil`` is changed in ``ways`` inside its
    ``wrapping``; ``read`` reads the folder and raises where something unsound was accepted.
    """

    write: Callable[[Path], None]
    spoil: str
    read: Callable[[Path], Any]
    ways: tuple[Way, ...]
    wrapping: Wrapping = PLAIN


def _sound(recordings: Any) -> None:
    """Raise if numbers were accepted that cannot be computed with."""
    for each in recordings:
        arrays = [each.time, *each.channels.values()]
        assert all(np.isfinite(values).all() and len(values) >= 2 for values in arrays), "numbers that are none"
        assert (np.diff(each.time) > 0).all(), "a time that does not increase"


def _folder(place: Path) -> None:
    _sound(read_folder(place / "bench"))


def _one_file(place: Path) -> None:
    _sound(read_file(place / "bench.h5"))


def _mapped(place: Path) -> None:
    _sound(read_mapped(place / "files", read_map(place / "map.yaml")))


def _joints(place: Path) -> None:
    for each in read_joints(place / "files", place / "source.yaml").recordings:
        assert all(np.isfinite(values).all() for values in (each.time, *each.signals.values())), "numbers that are none"


def _data_set(place: Path) -> None:
    found = storage.read(place / "set.h5")
    assert found.table["label"].notna().all(), "a label that is none"
    assert np.isfinite(found.rate), "a rate that is no number"


def _model(place: Path) -> None:
    model = models.load(next(place.glob("model.*")), "cpu")
    assert hasattr(model, "predict_proba"), "no classifier"


def _effects(place: Path) -> None:
    path = place / "effects.yaml"
    text.from_text(path.read_text(encoding="utf-8", errors="replace"), str(path))


def _truth(place: Path) -> None:
    """Spoiled before it was sealed, as somebody can who makes both."""
    content = (place / "bench.truth.json").read_bytes()
    (place / "bench" / SEAL).write_text(f"{hashlib.sha256(content).hexdigest()}  bench.truth.json\n")
    _hidden(place / "bench.truth.json", str(place / "bench"))


TARGETS = {
    "CSV folder": Target(seeds.folder, "bench/*.csv", _folder, TEXT),
    "one file (.h5)": Target(seeds.one_file, "bench.h5", _one_file, BINARY, SEALED),
    "one file, seal not renewed": Target(seeds.one_file, "bench.h5", _one_file, BINARY),
    ".mat": Target(partial(seeds.matlab, compressed=False), "files/*", _mapped, BINARY),
    ".mat, compressed": Target(partial(seeds.matlab, compressed=True), "files/*", _mapped, BINARY),
    ".mat 7.3 (HDF5)": Target(seeds.matlab_73, "files/*", _mapped, BINARY),
    "Parquet": Target(partial(seeds.parquet, compression=None), "files/*", _mapped, BINARY),
    "Parquet, compressed": Target(partial(seeds.parquet, compression="snappy"), "files/*", _mapped, BINARY),
    "CSV through a map": Target(seeds.foreign_csv, "files/*", _mapped, TEXT),
    "column map (YAML)": Target(seeds.foreign_csv, "map.yaml", _mapped, TEXT),
    "joints, .csv": Target(partial(seeds.joints, ending="csv"), "files/*", _joints, TEXT),
    "joints, .csv.gz": Target(partial(seeds.joints, ending="csv.gz"), "files/*", _joints, BINARY),
    "joints, inside .csv.gz": Target(partial(seeds.joints, ending="csv.gz"), "files/*", _joints, TEXT, GZIPPED),
    "source of joints (YAML)": Target(partial(seeds.joints, ending="csv"), "source.yaml", _joints, TEXT),
    "data set (.h5)": Target(seeds.data_set, "set.h5", _data_set, BINARY, SEALED),
    "data set, seal not renewed": Target(seeds.data_set, "set.h5", _data_set, BINARY),
    "network (.pt)": Target(seeds.network, "model.pt", _model, BINARY, ZIPPED),
    "network, whole archive": Target(seeds.network, "model.pt", _model, BINARY),
    "forest (.skops)": Target(seeds.forest, "model.skops", _model, (*BINARY, *TEXT), ZIPPED),
    "boosted trees (.skops)": Target(seeds.boosted, "model.skops", _model, (*BINARY, *TEXT), ZIPPED),
    "perceptron (.skops)": Target(seeds.perceptron, "model.skops", _model, (*BINARY, *TEXT), ZIPPED),
    "skops, whole archive": Target(seeds.forest, "model.skops", _model, BINARY),
    "effects.yaml": Target(seeds.effects, "effects.yaml", _effects, TEXT),
    "truth (.json)": Target(seeds.truth, "*.truth.json", _truth, TEXT),
}
