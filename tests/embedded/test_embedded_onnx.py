"""ONNX files give the labels and probabilities of the classifiers that they were made of."""

import json

import numpy as np
import pytest
from fabricated_rows import heavy_tailed

from learn.embedded import gateway
from learn.evaluation.evaluate import fit
from learn.methods.classical import multi_layer_perceptron, random_forest
from learn.methods.neural import convolutional_network, neural_perceptron
from learn.methods.strong import extra_trees, logistic_regression

REASON = "not installed: pip install '.[embedded]'"
onnxruntime = pytest.importorskip("onnxruntime", reason=REASON)
pytest.importorskip("skl2onnx", reason=REASON)
pytest.importorskip("onnxscript", reason=REASON)

METHODS = {
    "random forest": random_forest(20),
    "extra trees": extra_trees(20),
    "logistic regression": logistic_regression(),
    "multi-layer perceptron": multi_layer_perceptron(iterations=20),
    "perceptron": neural_perceptron(neurons=16, epochs=2),
    "convolutional network": convolutional_network(2, 16, width=4, epochs=2),
}


@pytest.fixture(scope="module")
def data():
    X, y = heavy_tailed(rows=900, columns=40, decades=1.0)
    return X.astype(float), y


@pytest.mark.parametrize("name", METHODS)
def test_a_file_says_what_its_classifier_says(name, data, tmp_path):
    (X, y), model, path = data, METHODS[name], tmp_path / "model.onnx"
    fit(model, X[:400], y[:400])
    gateway.write(model, path)
    found = gateway.check(path, model, X[400:])
    assert found.equal == found.recordings == 500
    assert found.difference < 1e-4
    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    assert json.loads(session.get_modelmeta().custom_metadata_map["classes"]) == list("ABCDEF")
    assert [(each.name, each.shape[1]) for each in session.get_inputs()] == [("row", 40)]
    assert [each.name for each in session.get_outputs()] == ["probability"]
    one = session.run(None, {"row": X[:1].astype(np.float32)})[0]
    assert one.shape == (1, 6)


def test_what_onnx_cannot_say_is_refused(data, tmp_path):
    from sklearn.dummy import DummyClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import FunctionTransformer

    X, y = data
    with pytest.raises(ValueError, match="DummyClassifier cannot become ONNX"):
        gateway.write(DummyClassifier().fit(X, y), tmp_path / "model.onnx")
    rooted = make_pipeline(FunctionTransformer(np.cbrt), random_forest(1)).fit(X, y)
    with pytest.raises(ValueError, match="cbrt"):
        gateway.write(rooted, tmp_path / "model.onnx")
    assert not list(tmp_path.iterdir())
