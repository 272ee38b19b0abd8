"""Forests in C vote as scikit-learn's do: exactly in single precision, and nearly so with 16 bits."""

import ctypes
import shutil
import subprocess

import numpy as np
import pytest
from embedded_fixtures import needs_compiler
from fabricated_rows import heavy_tailed
from sklearn.ensemble import ExtraTreesClassifier, RandomForestClassifier
from sklearn.naive_bayes import GaussianNB

from learn.embedded import forest
from learn.embedded.export import SOURCES
from learn.embedded.source import macros

TRAINED = 600
FORESTS = {
    "limited": RandomForestClassifier(20, max_depth=7, random_state=0),
    "at full depth": ExtraTreesClassifier(20, max_features=0.3, random_state=0),
    "grown best split first": RandomForestClassifier(10, max_leaf_nodes=40, random_state=0),
}


@pytest.fixture(scope="module")
def data():
    return heavy_tailed()


@pytest.fixture(scope="module", params=list(FORESTS))
def trained(request, data):
    X, y = data
    return FORESTS[request.param].fit(X[:TRAINED], y[:TRAINED])


def probabilities(folder, model, rows, numbers):
    """What the C says of each row."""
    files, sizes = forest.write(model, folder, numbers)
    sizes |= {"COLUMNS": rows.shape[1], "CLASSES": len(model.classes_), "ORDERS": 1}
    (folder / "model.h").write_text(macros(sizes))
    for name in (*files, "swg.h"):
        shutil.copyfile(SOURCES / name, folder / name)
    warnings = ("-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Werror")
    command = ["gcc", "-std=c11", "-O2", *warnings, "-shared", "-fPIC", "-o", "forest.so", *folder.glob("*.c")]
    subprocess.run(command, cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "forest.so"))
    said = np.zeros((len(rows), len(model.classes_)), np.float32)
    for row, probability in zip(rows, said, strict=True):
        library.swg_classify(row.ctypes.data_as(ctypes.c_void_p), probability.ctypes.data_as(ctypes.c_void_p))
    return said


@needs_compiler
def test_single_precision_is_exact(trained, data, tmp_path):
    rows = data[0][TRAINED:]
    expected = trained.predict_proba(rows)
    said = probabilities(tmp_path, trained, rows, "float")
    assert np.array_equal(said.argmax(axis=1), expected.argmax(axis=1))
    np.testing.assert_allclose(said, expected, atol=1e-5)


@needs_compiler
def test_a_value_at_a_threshold_goes_left_and_the_next_one_right(trained, data, tmp_path):
    rows = data[0][TRAINED : TRAINED + 1].repeat(600, axis=0)
    tree = trained.estimators_[0].tree_
    splits = np.resize(np.flatnonzero(tree.children_left >= 0), len(rows) // 2)
    at = tree.threshold[splits].astype(np.float32)
    values = np.concatenate([at, np.nextafter(at, np.float32(np.inf))])
    rows[np.arange(len(rows)), np.tile(tree.feature[splits], 2)] = values
    said = probabilities(tmp_path, trained, rows, "float")
    np.testing.assert_allclose(said, trained.predict_proba(rows), atol=1e-5)


@needs_compiler
def test_16_bits_keep_nearly_all_labels(trained, data, tmp_path):
    rows = data[0][TRAINED:]
    expected = trained.predict_proba(rows)
    said = probabilities(tmp_path, trained, rows, "int16")
    assert np.mean(said.argmax(axis=1) == expected.argmax(axis=1)) > 0.995
    assert np.abs(said - expected).mean() < 3e-3
    np.testing.assert_allclose(said.sum(axis=1), 1, atol=1e-6)


def test_codes_keep_the_order_and_the_sign():
    values = np.sort(np.concatenate([np.linspace(-3, 3, 4001), np.geomspace(1e-3, 1e30, 500)])).astype(np.float32)
    scale = [np.full_like(values, each) for each in (0, 1, forest.HIGHEST / 2.0**24)]  # up to a distance of 3
    codes = forest.coded(values, *scale).astype(int)
    assert (np.diff(codes) >= 0).all()
    assert (np.sign(codes) * np.sign(values) >= 0).all()
    assert codes.min() == -forest.HIGHEST
    assert (codes[values >= 3] == forest.HIGHEST).all()
    apart = values[1:] - values[:-1] > 2e-4 * (1 + np.abs(values[1:]))
    assert (np.diff(codes)[apart & (values[1:] <= 3)] > 0).all()


def test_what_is_no_forest_or_has_no_numbers_is_refused(trained, tmp_path):
    assert forest.is_forest(trained)
    assert not forest.is_forest(GaussianNB())
    with pytest.raises(ValueError, match="GaussianNB is no forest"):
        forest.write(GaussianNB(), tmp_path, "float")
    with pytest.raises(ValueError, match="int8"):
        forest.write(trained, tmp_path, "int8")
    assert not list(tmp_path.iterdir())
