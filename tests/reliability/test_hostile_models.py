"""Hostile models, lists of effects and truths: each is refused with its name (docs/reliability.md)."""

import io
import pickle
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import recording_fixtures as sound
import skops.io
import torch

from learn.evaluation import models
from swgsim.bench import truth
from swgsim.effects import text
from swgsim.recordings.files.source_map import read_map

BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join(['*' + a] * 9)}]\n" for a, b in zip("abcdefghi", "bcdefghij", strict=True)
)


def refused(read: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read()


# Models.


def rezipped(path: Path, compression: int = zipfile.ZIP_STORED, **changed: bytes) -> None:
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, content in (members | changed).items():
            archive.writestr(name, content)


def large_array(path: Path) -> None:
    with zipfile.ZipFile(path) as archive:
        name = next(name for name in archive.namelist() if name.endswith(".npy"))
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"shape": (2**32,), "fortran_order": False, "descr": "<f8"})
    rezipped(path, **{name: head.getvalue()})


def changed_network(change: Callable[[dict], object]) -> Callable[[Path], None]:
    def spoil(path: Path) -> None:
        content = torch.load(path, weights_only=True)
        change(content)
        torch.save(content, path)

    return spoil


def reversed_weights(path: Path) -> None:
    weights = torch.load(path, weights_only=True)["state"]["head.weight"].numpy().tobytes()
    path.write_bytes(path.read_bytes().replace(weights, weights[::-1]))


SPOILED_MODELS: dict[str, tuple[str, Callable[[Path], object]]] = {
    **{
        f"{kind}, {name}": (file, spoil)
        for kind, file in (("forest", "model.skops"), ("network", "model.pt"))
        for name, spoil in {
            "compressed": lambda path: rezipped(path, zipfile.ZIP_DEFLATED, bomb=bytes(10**7)),
            "truncated": lambda path: path.write_bytes(path.read_bytes()[:-30]),
        }.items()
    },
    "array larger than its part": ("model.skops", large_array),
    "network of 3.6 GB": (
        "model.pt", changed_network(lambda c: c["architecture"]["options"].update(neurons=10_000, layers=10)),
    ),
    "no network": ("model.pt", lambda path: torch.save(torch.zeros(3), path)),
    "weights of another network": (
        "model.pt", changed_network(lambda c: c["state"].__setitem__("head.weight", torch.zeros(5, 2))),
    ),
    "weights in another order": ("model.pt", reversed_weights),
    "weight NaN": ("model.pt", changed_network(lambda c: c["state"]["head.weight"].__setitem__((0, 0), torch.nan))),
}  # fmt: skip


@pytest.fixture(scope="module")
def sound_models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("models")
    for write in (sound.network, sound.forest):
        write(folder)
    for path in folder.iterdir():
        assert models.load(path, "cpu").predict(sound.training_rows()[0]).shape == (30,)
    return folder


@pytest.mark.parametrize("name", list(SPOILED_MODELS))
def test_a_spoiled_model_is_refused(tmp_path: Path, sound_models: Path, name: str) -> None:
    file, spoil = SPOILED_MODELS[name]
    path = tmp_path / file
    path.write_bytes((sound_models / file).read_bytes())
    spoil(path)
    refused(lambda: models.load(path, "cpu"), file.replace(".", r"\."))


class Harmful:
    """Leaves a trace when it is read, from a pickle or, of a type that skops trusts, from its state."""

    def __init__(self, trace: str) -> None:
        self.trace = trace

    def __reduce__(self) -> tuple:
        return Path.touch, (Path(self.trace),)

    def __getstate__(self) -> dict:
        return {"trace": self.trace}

    def __setstate__(self, state: dict) -> None:
        Path(state["trace"]).touch()


# How a harmful file is written, and how a careless program would read it.
HARMFUL: dict[str, tuple[str, Callable[[Harmful, Path], object], Callable[[Path], object]]] = {
    "pickle as forest": (
        "model.skops",
        lambda harm, path: path.write_bytes(pickle.dumps(harm)),
        lambda path: pickle.loads(path.read_bytes()),
    ),
    "pickle as network": (
        "model.pt",
        lambda harm, path: torch.save({"state": harm}, path),
        lambda path: torch.load(path, weights_only=False),
    ),
    "type of no classifier": (
        "model.skops",
        skops.io.dump,
        lambda path: skops.io.load(path, trusted=skops.io.get_untrusted_types(file=path)),
    ),
}


@pytest.mark.parametrize("name", list(HARMFUL))
def test_a_model_that_would_run_code_is_refused_and_does_not_run(tmp_path: Path, name: str) -> None:
    file, save, believe = HARMFUL[name]
    trace = tmp_path / "trace"
    save(Harmful(str(trace)), tmp_path / file)
    refused(lambda: models.load(tmp_path / file, "cpu"), file.replace(".", r"\."))
    assert not trace.exists()
    believe(tmp_path / file)
    assert trace.exists()  # the file is harmful


# Text.

TEXTS = {
    "tag": "effects: !!python/object/apply:os.system ['true']",
    "tag of a name": "effects: [!!python/name:os.system ]",
    "aliases": BOMB + "effects: *j",
    "merged": "a: &a {x: 1}\nb: {<<: [*a, *a]}\neffects: []",
    "deep": "effects: " + "[" * 20_000,
    "impossible day": "effects: 2001-13-45",
    "many digits": f"effects: {'9' * 5000}",
    "key twice": "effects: []\neffects: []",
    "unlimited number": f"effects: [eccentric_wave_generator: {{r: {10**400}, theta: 1}}]",
    "module of Python": "effects: [antigravity:Effect: {}]",
    "no effect": "effects: [os:system: {}]",
    "no path": "effects: ['../a:b': {}]",
    "no text": "\x00",
}


@pytest.mark.parametrize("name", list(TEXTS))
def test_effects_and_maps_are_plain_data(tmp_path: Path, name: str) -> None:
    loaded = set(sys.modules)
    refused(lambda: text.from_text(TEXTS[name], "mine.yaml"), r"mine\.yaml")
    assert "antigravity" not in set(sys.modules) - loaded
    (tmp_path / "map.yaml").write_text(TEXTS[name])
    refused(lambda: read_map(tmp_path / "map.yaml"), r"map\.yaml")


@pytest.mark.parametrize("content", ["[" * 100_000, "9" * 5000, "[]", "3", '{"files": 3}', "\udcff"])
def test_a_truth_that_is_not_one(tmp_path: Path, content: str) -> None:
    sound.truth(tmp_path)
    raw = content.encode(errors="surrogateescape")
    (tmp_path / "bench.truth.json").write_bytes(raw)
    (tmp_path / "bench" / truth.SEAL).write_text(truth._digest(raw))
    refused(lambda: truth.open_truth(tmp_path / "bench"), r"bench\.truth\.json")
