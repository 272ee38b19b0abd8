"""Neural classifiers learn a pattern, score chance on noise, and come back from their files."""

import numpy as np
import pytest

from learn.methods import neural
from learn.methods.contract import Classifier
from learn.methods.networks import convolutional

CHANNELS, POINTS, SIDE = 2, 16, 2
COLUMNS = CHANNELS * POINTS + SIDE
NAMES = np.array(["tip", "healthy", "root"])
SMALL = {"perceptron": {"neurons": 32}, "convolutional": {"width": 8}, "residual": {"width": 8}}
FACTORIES = {
    "perceptron": neural.neural_perceptron,
    "convolutional": neural.convolutional_network,
    "residual": neural.residual_network,
}

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
def test_shuffled_labels_are_memorised_and_score_chance_on_new_recordings(kind):
    """Without the pulses: a mere pulse would move all rows of a class alike, and the score were not binomial."""
    rng = np.random.default_rng(0)
    X, new = rng.standard_normal((120, COLUMNS)), rng.standard_normal((900, COLUMNS))
    y, truth = rng.permutation(np.repeat(NAMES, 40)), np.repeat(NAMES, 300)
    model = classifier(kind, epochs=40, batch=24, dropout=0.0).fit(X, y)
    deviation = np.sqrt(1 / 3 * 2 / 3 / len(new))  # binomial
    assert np.mean(model.predict(X) == y) > 0.95
    assert np.mean(model.predict(new) == truth) == pytest.approx(1 / 3, abs=4 * deviation)


@both
def test_a_file_gives_the_classifier_back_with_the_scaling_of_its_training(kind, tmp_path):
    X, y = task(60)
    model = classifier(kind, epochs=2, seed=4).fit(X, y)
    model.predict_proba(1e6 + X)
    neural.save(model, tmp_path / "model.pt")
    back = neural.load(tmp_path / "model.pt", "cpu")
    assert np.array_equal(back.predict_proba(X), model.predict_proba(X))
    assert np.array_equal(back.predict(X), model.predict(X))
    assert (back.architecture, back.recipe, back.seed) == (model.architecture, model.recipe, model.seed)
    assert [path.name for path in tmp_path.iterdir()] == ["model.pt"]
    state = back.network_.state_dict()
    np.testing.assert_allclose(state["centre"].numpy(), np.median(X, axis=0), rtol=1e-6)
    of_channel = np.median(np.abs(X - np.median(X, axis=0))[:, :POINTS]) * 1.4826
    np.testing.assert_allclose(state["scale"].numpy()[:POINTS], of_channel, rtol=1e-6)


@both
def test_a_seed_gives_the_same_file_and_another_seed_another(kind, tmp_path):
    X, y = task(30)
    for name, seed in (("one", 7), ("two", 7), ("other", 8)):
        neural.save(classifier(kind, epochs=1, seed=seed).fit(X, y), tmp_path / name)
    one, two, other = ((tmp_path / name).read_bytes() for name in ("one", "two", "other"))
    assert one == two
    assert one != other


def test_a_copy_with_another_network_and_smaller_chunks_leave_the_first_as_it_is(monkeypatch):
    X, y = task(30)
    model = classifier("convolutional", epochs=1).fit(X, y)
    before = model.predict_proba(X)
    other = model.with_network(convolutional(CHANNELS, POINTS, COLUMNS, classes=3, seed=9))
    assert not np.allclose(other.predict_proba(X), before)
    assert np.array_equal(model.predict_proba(X), before)
    assert np.array_equal(other.classes_, model.classes_)
    monkeypatch.setattr("learn.inputs.rows.CHUNK", 7)
    np.testing.assert_allclose(model.predict_proba(X), before, atol=1e-6)


def test_misuse_is_answered_with_the_remedy():
    X, y = task(12)
    model = classifier("perceptron", epochs=1)
    with pytest.raises(ValueError, match="not trained: call fit first"):
        model.predict(X)
    with pytest.raises(ValueError, match=r"have 1 class \(tip\), 2 are needed"):
        model.fit(X, np.repeat("tip", 12))
    model.fit(X, y)
    with pytest.raises(ValueError, match=f"rows have 3 columns, the network was trained with {COLUMNS}"):
        model.predict(X[:, :3])
    X[2, 5] = np.nan
    for use in (model.predict, lambda rows: model.fit(rows, y)):
        with pytest.raises(ValueError, match="column 5 of row 2 is nan"):
            use(X)
