"""classifier=fast_twin: trained on simulated gears that are none of the data set, once for every choice and seed."""

import tracemalloc
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from chain_fixtures import GEAR
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from twin_fixtures import PLAN, POINTS, SMALL, recordings

from learn.inputs.referenced import Referenced
from learn.inputs.rows import Rows
from learn.jobs import identity, settings
from learn.methods import training_gears
from learn.methods.fast_twin import FastTwin
from learn.methods.fault_outputs import FaultOutputs
from swgsim.oracle.diagnosis import FOUND
from swgsim.storage.labelled_signals import CLASSES

pytestmark = pytest.mark.end_to_end
CONF = str(Path(__file__).parents[2] / "conf")
ROWS = Referenced("referenced").learning_set([recordings()])
LABELS = ROWS.table["label"].astype(str).to_numpy()


def untrained(models: Path, **options: object) -> FastTwin:
    choices = ["grid=sampled", "condition=bench", "classifier=fast_twin", "features=referenced", "grid.scatter=0.005",
               "classifier.mesh.sectors=40", "classifier.window.samples=160", "workers=1", "grid.references=4",
               "grid.speeds_rpm=[4000]", "grid.loads_nm=[20,60]"]  # fmt: skip
    with initialize_config_dir(CONF, version_base="1.3"):
        config = OmegaConf.to_container(compose("train", choices).classifier, resolve=True)
    config["grid"]["severities"] = {label: list(levels) for label, levels in SMALL.items()}
    config["gear"] = {"number": GEAR.number}
    config |= {"gears": 12, "variants": 4, "neurons": 32, "epochs": 10, "batch": 64, "models": str(models)} | options
    return settings.classifier(config)()


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> FastTwin:
    return untrained(tmp_path_factory.mktemp("models")).fit(ROWS.features, LABELS)


@pytest.mark.slow
def test_a_short_training_on_other_gears_beats_the_prior(trained: FastTwin) -> None:
    said = trained.predict_proba(ROWS.features)
    np.testing.assert_allclose(said.sum(axis=1), 1)
    assert trained.classes_.tolist() == sorted(CLASSES)
    np.testing.assert_array_equal(trained.predict(ROWS.features), trained.classes_[said.argmax(axis=1)])
    assert np.mean(trained.predict(ROWS.features) == LABELS) > 2 / len(CLASSES)
    surprise = -np.log(said[np.arange(len(said)), np.searchsorted(trained.classes_, LABELS)])
    assert surprise.mean() < 0.9 * np.log(len(CLASSES))


def test_gears_of_the_training_are_none_of_the_data_set(trained: FastTwin) -> None:
    drawn = {gear.transmission.b1 for gear in trained.plan.gears}
    assert len(drawn) == 12
    assert not drawn & {gear.transmission.b1 for gear in PLAN.gears}
    assert trained.plan.grid.seed != PLAN.grid.seed


def test_a_diagnosis_has_sizes_and_positions_of_the_believed_faults(trained: FastTwin) -> None:
    found = trained.diagnosis(ROWS.features)
    assert list(found) == [*CLASSES, *FOUND]
    likeliest = np.array(CLASSES)[found[list(CLASSES)].to_numpy().argmax(axis=1)]
    assert found.loc[likeliest == "healthy", list(FOUND)].isna().all(axis=None)
    for label, sizes in SMALL.items():
        rows = found[likeliest == label]
        assert rows["severity_low"].ge(min(sizes) * (1 - 1e-9)).all()
        assert rows["severity_high"].le(max(sizes) * (1 + 1e-9)).all()
        assert (rows["severity_low"] <= rows["severity"]).all()
        assert rows["position"].notna().all() == (not label.startswith("reduced"))


def test_the_seed_decides_every_byte_and_a_file_is_read_again(trained: FastTwin, tmp_path: Path) -> None:
    kept = trained.path.read_bytes()
    again = untrained(tmp_path).fit(ROWS.features[:6], LABELS[:6])
    assert again.path.name == trained.path.name
    assert again.path.read_bytes() == kept
    again.path.write_bytes(kept[:-100])
    with pytest.raises(ValueError, match=r"is no such network, or damaged: remove it"):
        again.fit(ROWS.features[:6], LABELS[:6])
    trained.fit(ROWS.features[:6], LABELS[:6])
    assert trained.path.read_bytes() == kept
    assert untrained(tmp_path, seed=1).path != untrained(tmp_path).path != untrained(tmp_path, neurons=16).path


def test_folders_and_processes_are_not_in_the_key_of_a_job() -> None:
    def key(**options: object) -> str:
        return identity.job_key({"classifier": {"name": "fast_twin", **options}}, "digest")

    assert key(models="here", workers=1) == key(models="there", workers=2) != key(gears=5)


def test_other_rows_and_unknown_classes_are_refused(trained: FastTwin, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"40 columns are no rows with references: choose features=referenced"):
        trained.diagnosis(np.zeros((2, 40)))
    with pytest.raises(ValueError, match=r"class 'broken' is not among the classes of the believed grid"):
        untrained(tmp_path).fit(np.zeros((1, 40)), np.array(["broken"]))
    with pytest.raises(ValueError, match=r"trained for the operating points \[4000, 20\], \[4000, 60\]"):
        trained.diagnosis(np.asarray(ROWS.features)[:, : 2 + 127 + 130])


def test_memory_does_not_grow_with_the_number_of_gears(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def peak(gears: int) -> int:
        def simulated(*_: object) -> Iterator[tuple[np.ndarray, np.ndarray]]:
            for _gear in range(gears):
                yield np.ones((100, 1000)), np.zeros((100, 3))

        engine, plan = SimpleNamespace(results=simulated), SimpleNamespace(gears=range(gears))
        tracemalloc.start()
        rows, targets = training_gears.training_gears(plan, FaultOutputs({}), engine, tmp_path)
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert isinstance(rows, Rows)
        assert rows.shape == (100 * gears, 1000)
        assert len(targets) == 100 * gears
        return found

    assert peak(32) < 1.5 * peak(4)


def test_weights_are_read_without_running_code(trained: FastTwin) -> None:
    state = torch.load(trained.path, weights_only=True)
    assert set(state) == set(trained.network_.state_dict())
    assert len(state["head.bias"]) == len(trained.outputs)
    assert trained.plan.grid.points == POINTS
