"""Neural classifiers learn what can be learnt, nothing where there is nothing, and survive their files."""

import pickle
from pathlib import Path

import numpy as np
import pytest
import torch

from learn.methods import neural
from learn.methods.contract import Classifier
from learn.methods.networks import convolutional

CHANNELS, POINTS, SIDE = 2, 16, 2
COLUMNS = CHANNELS * POINTS + SIDE
NAMES = np.array(["tip", "healthy", "root"])
SMALL = {"perceptron": {"neurons": 32}, "convolutional": {"width": 8}}
FACTORIES = {"perceptron": neural.neural_perceptron, "convolutional": neural.convolutional_network}

both = pytest.mark.parametrize("kind", list(FACTORIES))


def classifier(kind: str, **options: object) -> neural.NeuralClassifier:
    return FACTORIES[kind](CHANNELS, POINTS, **{"device": "cpu", "rate": 1e-2, **SMALL[kind], **options})


def task(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Noise; the class is the height of a pulse, or of a side column."""
    rng = np.random.default_rng(seed)
    y = NAMES[np.arange(count) % 3]
    X = rng.standard_normal((count, COLUMNS))
    X[y == "tip", 3] += 8.0
    X[y == "root", -1] += 8.0
    return X, y


@both
def test_eight_recordings_are_learnt_by_heart(kind):
    X = np.random.default_rng(0).standard_normal((8, COLUMNS))
    y = np.array(["c", "a", "b", "a", "c", "b", "a", "b"])
    model = classifier(kind, epochs=150, dropout=0.0).fit(X, y)
    assert np.array_equal(model.predict(X), y)


@both
def test_what_was_learnt_holds_on_new_recordings_whatever_the_order_of_names(kind):
    X, y = task(300)
    model = classifier(kind, batch=32).fit(X[::-1], y[::-1])
    new, truth = task(150, seed=1)
    new.setflags(write=False)
    assert isinstance(model, Classifier)
    assert model.classes_.tolist() == ["healthy", "root", "tip"]
    assert np.mean(model.predict(new) == truth) > 0.95
    probabilities = model.predict_proba(new)
    np.testing.assert_allclose(probabilities.sum(axis=1), 1.0, atol=1e-12)
    assert np.array_equal(model.classes_[probabilities.argmax(axis=1)], model.predict(new))


@both
def test_shuffled_labels_are_learnt_by_heart_and_score_chance_on_new_recordings(kind):
    """Without the pulses: a mere pulse would move all rows of a class alike, and the score were not binomial."""
    rng = np.random.default_rng(0)
    X, new = rng.standard_normal((120, COLUMNS)), rng.standard_normal((900, COLUMNS))
    y, truth = rng.permutation(np.repeat(NAMES, 40)), np.repeat(NAMES, 300)
    model = classifier(kind, epochs=60, batch=32, dropout=0.0).fit(X, y)
    deviation = np.sqrt(1 / 3 * 2 / 3 / len(new))  # binomial
    assert np.mean(model.predict(X) == y) > 0.95
    assert np.mean(model.predict(new) == truth) == pytest.approx(1 / 3, abs=4 * deviation)


@both
def test_scaling_comes_from_the_fitted_rows_and_travels_with_the_file(kind, tmp_path):
    X, y = task(60)
    model = classifier(kind, epochs=1).fit(X, y)
    model.predict_proba(1e6 + X)
    neural.save(model, tmp_path / "model.pt")
    for each in (model, neural.load(tmp_path / "model.pt", "cpu")):
        np.testing.assert_allclose(each.network_.state_dict()["centre"].numpy(), np.median(X, axis=0), rtol=1e-6)
        scale = each.network_.state_dict()["scale"].numpy()
        of_channel = np.median(np.abs(X - np.median(X, axis=0))[:, :POINTS]) * 1.4826
        np.testing.assert_allclose(scale[:POINTS], of_channel, rtol=1e-6)


def test_a_fit_leaves_the_state_of_pytorch_as_it_was():
    state, threads = torch.get_rng_state(), torch.get_num_threads()
    X, y = task(30)
    classifier("convolutional", epochs=1).fit(X, y).predict_proba(X)
    assert torch.equal(torch.get_rng_state(), state)
    assert torch.get_num_threads() == threads


@both
def test_a_seed_gives_the_same_file_and_another_seed_another(kind, tmp_path):
    X, y = task(30)
    for name, seed in (("one", 7), ("two", 7), ("other", 8)):
        neural.save(classifier(kind, epochs=1, seed=seed).fit(X, y), tmp_path / name)
    one, two, other = ((tmp_path / name).read_bytes() for name in ("one", "two", "other"))
    assert one == two
    assert one != other


@both
def test_a_file_gives_the_classifier_back(kind, tmp_path):
    X, y = task(60)
    model = classifier(kind, epochs=2, seed=4).fit(X, y)
    neural.save(model, tmp_path / "model.pt")
    back = neural.load(tmp_path / "model.pt", "cpu")
    assert np.array_equal(back.predict_proba(X), model.predict_proba(X))
    assert np.array_equal(back.predict(X), model.predict(X))
    assert (back.architecture, back.recipe, back.seed) == (model.architecture, model.recipe, model.seed)
    assert [path.name for path in tmp_path.iterdir()] == ["model.pt"]


class Harmful:
    """Leaves a trace when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self):
        return Path.touch, (self.trace,)


def test_harmful_files_are_refused_and_not_executed(tmp_path):
    bare, archive, trace = tmp_path / "bare.pt", tmp_path / "archive.pt", tmp_path / "trace"
    bare.write_bytes(pickle.dumps(Harmful(trace)))
    torch.save({"state": Harmful(trace)}, archive)
    for path in (bare, archive):
        with pytest.raises(ValueError, match=f"{path.name} is no neural classifier"):
            neural.load(path)
        assert not trace.exists()
    pickle.loads(bare.read_bytes())
    assert trace.exists()  # it would have


@pytest.mark.parametrize("content", [{"weights": torch.zeros(2)}, torch.zeros(3), [1, 2]])
def test_files_of_something_else_are_refused(content, tmp_path):
    path = tmp_path / "other.pt"
    torch.save(content, path)
    with pytest.raises(ValueError, match=r"other\.pt is no neural classifier: give a file that"):
        neural.load(path)


def test_a_weight_that_has_changed_in_the_file_is_noticed(tmp_path):
    X, y = task(30)
    path = tmp_path / "model.pt"
    model = classifier("perceptron", epochs=1).fit(X, y)
    neural.save(model, path)
    content, weights = path.read_bytes(), model.network_.head.weight.detach().numpy().tobytes()
    assert content.count(weights) == 1
    path.write_bytes(content.replace(weights, weights[::-1]))
    with pytest.raises(ValueError, match=r"model\.pt is no neural classifier"):
        neural.load(path)


def test_weights_of_another_network_are_refused(tmp_path):
    X, y = task(30)
    model = classifier("convolutional", epochs=1).fit(X, y)
    wrong = model.with_network(convolutional(CHANNELS, POINTS, COLUMNS, classes=5, width=8))
    neural.save(wrong, tmp_path / "wrong.pt")
    with pytest.raises(ValueError, match=r"wrong\.pt is no neural classifier"):
        neural.load(tmp_path / "wrong.pt")


def test_a_copy_with_another_network_leaves_the_first_alone():
    X, y = task(30)
    model = classifier("convolutional", epochs=1).fit(X, y)
    before = model.predict_proba(X)
    other = model.with_network(convolutional(CHANNELS, POINTS, COLUMNS, classes=3, seed=9))
    assert not np.allclose(other.predict_proba(X), before)
    assert np.array_equal(model.predict_proba(X), before)
    assert np.array_equal(other.classes_, model.classes_)


def test_chunks_do_not_show(monkeypatch):
    X, y = task(30)
    model = classifier("convolutional", epochs=1).fit(X, y)
    whole = model.predict_proba(X)
    monkeypatch.setattr("learn.inputs.rows.CHUNK", 7)
    np.testing.assert_allclose(model.predict_proba(X), whole, atol=1e-6)


def test_misuse_is_answered_with_the_remedy():
    X, y = task(12)
    model = classifier("perceptron", epochs=1)
    with pytest.raises(ValueError, match="not trained: call fit first"):
        model.predict(X)
    with pytest.raises(ValueError, match=r"of 1 class \(tip\), 2 are needed"):
        model.fit(X, np.repeat("tip", 12))
    model.fit(X, y)
    with pytest.raises(ValueError, match=f"rows have 3 columns, the network was trained with {COLUMNS}"):
        model.predict(X[:, :3])
    X[2, 5] = np.nan
    for use in (model.predict, lambda rows: model.fit(rows, y)):
        with pytest.raises(ValueError, match="column 5 of row 2 is nan"):
            use(X)
