"""Data sets larger than the memory: the same inputs, networks and scores as in memory."""

import tracemalloc

import numpy as np
import pytest
from fabricated import recordings
from hypothesis import given
from hypothesis import strategies as st

from learn.evaluation.evaluate import evaluate
from learn.inputs.features import Selection
from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import LearningSet, gear_by_gear
from learn.inputs.rows import CHUNK, Rows, chunks, on_disk
from learn.inputs.signals import Signals
from learn.methods import neural
from learn.methods.classical import random_forest
from learn.methods.neural import NeuralClassifier, convolutional_network, neural_perceptron
from learn.protocols.splits import RandomFolds

REPRESENTATIONS = (
    Selection("selection", statistics=True, spectrum="both", efficiency="both"), Harmonics("harmonics", 6),
    Signals("residual", points=16, orders=6),
)  # fmt: skip


@pytest.fixture(scope="module")
def data():
    return recordings(gears=3, disturbance=0.02)


def in_blocks(data, rows=37):
    """Blocks that end in the middle of a gear."""
    numbers = np.arange(len(data))
    return (data.where(numbers[start : start + rows]) for start in range(0, len(data), rows))


def in_file(data, representation, folder) -> LearningSet:
    return gear_by_gear(in_blocks(data), representation, folder, lambda _: None)


@pytest.mark.parametrize("representation", REPRESENTATIONS, ids=lambda each: type(each).__name__)
def test_a_large_data_set_has_the_same_inputs(data, representation, tmp_path):
    whole = representation.learning_set([data])
    done: list[int] = []
    large = gear_by_gear(in_blocks(data), representation, tmp_path, done.append)
    np.testing.assert_allclose(np.asarray(large.features), whole.features, rtol=1e-12, atol=1e-12)
    assert large.table.equals(whole.table)
    assert (large.names, large.layout) == (whole.names, whole.layout)
    assert sum(done) == len(data)
    assert not list(tmp_path.iterdir()), "the file has no name, so that nothing is left of it"


def test_the_memory_it_takes_is_that_of_one_gear(tmp_path):
    """A gear more takes its facts, and not its inputs, which are three times as much."""

    def peak(gears: int) -> int:
        data = recordings(gears, variants=12)
        tracemalloc.start()
        in_file(data, Signals("residual", points=256), tmp_path)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    inputs = 4 * 6 * 12 * 5 * 256 * 8  # bytes of a gear
    assert peak(4) - peak(2) < 0.5 * 2 * inputs


def network(kind: str, data: LearningSet) -> NeuralClassifier:
    layout = data.layout._asdict()
    if kind == "convolutional":
        return convolutional_network(**layout, width=8, epochs=2, batch=32, device="cpu")
    return neural_perceptron(**layout, layers=1, neurons=8, epochs=2, batch=32, device="cpu")


@pytest.mark.parametrize("kind", ["convolutional", "perceptron"])
def test_a_network_learns_the_same_from_rows_in_a_file(data, kind, tmp_path):
    large = in_file(data, REPRESENTATIONS[2], tmp_path)
    y = large.table["label"].astype(str).to_numpy()
    both = [network(kind, large).fit(X, y).predict_proba(X) for X in (np.asarray(large.features), large.features)]
    np.testing.assert_array_equal(*both)


@pytest.mark.parametrize("method", [lambda data: network("perceptron", data), lambda _: random_forest(trees=5)])
def test_scores_do_not_depend_on_where_the_inputs_lie(data, method, tmp_path):
    large = in_file(data, REPRESENTATIONS[0], tmp_path)
    y = large.table["label"].astype(str).to_numpy()
    folds = RandomFolds(2)
    here, there = (
        evaluate(X, y, folds.split(X, large.table), lambda: method(large))
        for X in (np.asarray(large.features), large.features)
    )
    np.testing.assert_array_equal(here.confusion, there.confusion)
    np.testing.assert_array_equal(here.probabilities, there.probabilities)


def test_training_reads_no_more_than_a_batch_at_a_time(data, tmp_path, monkeypatch):
    large = in_file(data, REPRESENTATIONS[2], tmp_path)
    read: list[int] = []
    reading = Rows.__array__

    def noted(rows, dtype=None, copy=None):
        read.append(len(rows))
        return reading(rows, dtype, copy)

    monkeypatch.setattr(Rows, "__array__", noted)
    monkeypatch.setattr(neural, "SCALED", 50)
    monkeypatch.setattr("learn.inputs.rows.CHUNK", 40)
    y = large.table["label"].astype(str).to_numpy()
    model = network("perceptron", large).fit(large.features, y)
    model.predict(large.features)
    assert max(read) == 50 < len(large.features)
    assert sum(read) == 50 + 5 * len(large.features)  # scaling; looked through, twice; trained on, twice; judged


def test_a_gear_in_two_places_is_refused(data, tmp_path):
    gears = data.table["gear"].to_numpy()
    torn = [data.where(gears == 1), data.where(gears == 2), data.where(gears == 1)]
    with pytest.raises(ValueError, match="recordings of gear 1 in two places of the data set"):
        gear_by_gear(torn, REPRESENTATIONS[0], tmp_path, lambda _: None)


@given(st.lists(st.integers(0, 5), max_size=6), st.data())
def test_rows_in_a_file_are_those_of_the_table(tmp_path_factory, sizes, data):
    parts = [np.arange(3.0 * size).reshape(size, 3) + 100 * i for i, size in enumerate([*sizes, 2])]
    table = np.concatenate(parts)
    rows = on_disk(parts, tmp_path_factory.getbasetemp())
    chosen = data.draw(st.lists(st.integers(0, len(table) - 1)))
    again = data.draw(st.slices(len(chosen)))
    np.testing.assert_array_equal(np.asarray(rows), table)
    np.testing.assert_array_equal(np.asarray(rows[np.array(chosen, dtype=int)][again]), table[chosen][again])
    assert rows.shape == table.shape


def test_chunks_hold_all_rows_once(tmp_path):
    table = np.arange(2.0 * CHUNK + 1)[:, None]
    read = list(chunks(on_disk([table], tmp_path)))
    assert [len(chunk) for chunk in read] == [CHUNK, CHUNK, 1]
    np.testing.assert_array_equal(np.concatenate(read), table)
    assert [len(chunk) for chunk in chunks(table[:0])] == [0]
