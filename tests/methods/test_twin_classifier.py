"""classifier=twin: rows say all that it needs, it learns nothing from training, and keeps the contract."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chain_fixtures import GEAR
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from twin_fixtures import DRAWN, KNOWLEDGE, PLAN, POINTS, SMALL, recordings

from learn.inputs.referenced import Referenced
from learn.jobs import identity, settings
from learn.methods.twin import TwinClassifier
from swgsim.dataset.simulate_cases import record
from swgsim.oracle.cells import Resolution
from swgsim.oracle.model import observations
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals
from swgsim.twin import References, Twin, fit_gear

pytestmark = pytest.mark.end_to_end
# Enough for a twin that is only compared with itself.
COARSE = Resolution(draws=40, nodes=2, positions={"eccentric_wave_generator": 4, "tip_tooth_crack": 4})
CONF = str(Path(__file__).parents[2] / "conf")


def learned(*blocks: LabelledSignals):
    return Referenced("referenced").learning_set(blocks)


@pytest.fixture(scope="module")
def classifier() -> TwinClassifier:
    choices = [
        "grid=sampled", "condition=bench", "classifier=twin", "features=referenced", "grid.scatter=0.005",
        "classifier.mesh.sectors=40", "classifier.window.samples=160",
    ]  # fmt: skip
    with initialize_config_dir(CONF, version_base="1.3"):
        config = OmegaConf.to_container(compose("train", choices).classifier, resolve=True)
    config["grid"]["severities"] = {label: list(levels) for label, levels in SMALL.items()}
    config["grid"]["seed"] = PLAN.grid.seed
    config["gear"] = {"number": GEAR.number}  # and the defaults of all else, as the nominal gear of the fixtures
    config["resolution"] = {"draws": COARSE.draws, "nodes": COARSE.nodes, "positions": dict(COARSE.positions)}
    return settings.classifier(config)()


def test_rows_have_a_recording_and_the_references_of_its_gear() -> None:
    data = recordings()
    made = learned(data)
    pd.testing.assert_frame_equal(made.table, data.samples.table)
    x, references = observations(data.samples), References.of(data)
    np.testing.assert_array_equal(made.features[:, :2], data.samples.table[["n_in_rpm", "T_out_nm"]])
    np.testing.assert_array_equal(made.features[:, 2 : 2 + x.shape[1]], x)
    said = made.features[:, 2 + x.shape[1] :].reshape(len(x), len(POINTS), -1)
    assert (said == said[0]).all()
    np.testing.assert_array_equal(said[0, :, :2], [[point.n_in_rpm, point.T_out] for point in POINTS])
    np.testing.assert_array_equal(said[0, :, 2], 20)
    np.testing.assert_array_equal(said[0, :, 3:], references.mean)


def test_rows_depend_on_no_other_gear_and_no_other_recording() -> None:
    """No leakage: the row of a recording is the same whatever else the data set has, in whatever blocks."""
    data = recordings()
    other = record(replace(PLAN, gears=(replace(DRAWN, number=7),)), list(PLAN.grid.cases(replace(DRAWN, number=7))))
    half = data.where(data.table["reference"] | (np.arange(len(data)) % 2 == 0))
    kept = np.flatnonzero(~data.table["reference"] & (np.arange(len(data)) % 2 == 0)) - data.table["reference"].sum()
    alone = learned(data).features
    np.testing.assert_array_equal(learned(half).features, alone[kept])
    both = learned(data, other)
    np.testing.assert_array_equal(both.features[both.table["gear"] == DRAWN.number], alone)


def test_gears_with_other_operating_points_are_refused() -> None:
    data = recordings()
    few = data.where(data.table["T_out_nm"] == POINTS[0].T_out)
    few = replace(few, table=few.table.assign(gear=np.int32(9)))
    with pytest.raises(ValueError, match=r"gear 9 has references at other operating points"):
        learned(data, few)


def test_the_classifier_is_the_twin_and_is_trained_on_nothing(classifier: TwinClassifier) -> None:
    made = learned(recordings())
    some = np.arange(0, len(made.table), 9)
    X, y = made.features[some], made.table["label"].astype(str).to_numpy()[some]
    wrong = np.roll(y, 1)
    said = classifier.fit(X[:6], np.array(CLASSES)).predict_proba(X)
    np.testing.assert_array_equal(classifier.fit(X, wrong).predict_proba(X), said)
    assert classifier.classes_.tolist() == sorted(CLASSES)
    np.testing.assert_allclose(said.sum(axis=1), 1)
    np.testing.assert_array_equal(classifier.predict(X), classifier.classes_[said.argmax(axis=1)])
    # A row is judged by itself.
    np.testing.assert_allclose(classifier.predict_proba(X[3:4])[0], said[3], atol=1e-9)
    # The same twin, made by hand.
    knowledge = replace(KNOWLEDGE, resolution=COARSE)
    twin = Twin.of(knowledge, fit_gear(knowledge, References.of(recordings())))
    first = X[:, 1] == POINTS[0].T_out
    by_hand = np.exp(twin.densities([POINTS[0]]).log_posterior(X[first, 2:129]))
    order = [CLASSES.index(name) for name in classifier.classes_]
    np.testing.assert_allclose(said[first], by_hand[:, order], atol=1e-6)
    found = classifier.diagnosis(X)
    faulty = found["severity"].notna()
    assert (found.loc[faulty, "severity_low"] <= found.loc[faulty, "severity_high"]).all()


def test_other_inputs_are_refused(classifier: TwinClassifier) -> None:
    with pytest.raises(ValueError, match=r"40 columns are no rows with references: choose features=referenced"):
        classifier.fit(np.zeros((2, 40)), np.array(CLASSES[:2])).predict_proba(np.zeros((2, 40)))
    with pytest.raises(ValueError, match=r"class 'broken' is not among the classes of the believed grid"):
        classifier.fit(np.zeros((1, 40)), np.array(["broken"]))


def test_the_key_of_a_job_covers_the_physics_of_a_twin_only(monkeypatch: pytest.MonkeyPatch) -> None:
    twin, forest = ({"classifier": {"name": name}} for name in ("twin", "rf"))
    before = [identity.job_key(config, "digest") for config in (twin, forest)]
    monkeypatch.setattr(identity, "version_of_subpackages", lambda *_: "another")
    after = [identity.job_key(config, "digest") for config in (twin, forest)]
    assert before[0] != after[0]
    assert before[1] == after[1]
