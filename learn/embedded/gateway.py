"""Trained classifiers as ONNX files, for gateways that run onnxruntime or its like.

A file takes rows of features, ``row`` [n, columns] in single precision, and gives ``probability`` [n, classes]; the
names of the classes, as a JSON list in the order of the columns, are its metadata ``classes``.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from learn.embedded.proof import Agreement
from learn.methods.neural import NeuralClassifier
from swgsim.common.files import replacing

if TYPE_CHECKING:
    from onnx import ModelProto

ROW, PROBABILITY, CLASSES = "row", "probability", "classes"
LONGEST_REASON = 100  # characters


def write(model: Any, path: Path) -> None:
    """Write a trained classifier; the file is complete or absent.

    Parameters
    ----------
    model : classifier
        A network of this project, or an estimator or pipeline of scikit-learn.
    path : Path
        Of the ONNX file.

    Raises
    ------
    ValueError
        If the method cannot be exported to ONNX, or the libraries for it are not installed.
    """
    try:
        from onnx.helper import set_model_props

        proto = _network(model) if isinstance(model, NeuralClassifier) else _estimator(model)
    except ImportError as error:
        raise ValueError(f"target=onnx needs {error.name}: pip install 'swg-workbench[embedded]'") from error
    set_model_props(proto, {CLASSES: json.dumps([str(name) for name in model.classes_])})
    with replacing(path) as aside:
        aside.write_bytes(proto.SerializeToString())


def check(path: Path, model: Any, rows: Float[np.ndarray, "row column"]) -> Agreement:
    """Agreement of a file in onnxruntime with the original classifier."""
    from onnxruntime import InferenceSession, SessionOptions

    options = SessionOptions()
    options.intra_op_num_threads = 1  # votes are summed in the order of the trees, so that ties stay ties
    session = InferenceSession(path, options, providers=["CPUExecutionProvider"])
    (probability,) = session.run([PROBABILITY], {ROW: rows.astype(np.float32)})
    expected = model.predict_proba(rows)
    equal = probability.argmax(axis=1) == expected.argmax(axis=1)
    return Agreement(len(rows), len(rows), int(equal.sum()), float(np.abs(probability - expected).max(initial=0)))


def _network(model: NeuralClassifier) -> "ModelProto":
    import torch
    from torch import nn

    network = model.network_
    whole = nn.Sequential(network, nn.Softmax(dim=1)).eval()
    example = torch.zeros(2, len(network.centre), device=network.centre.device)
    program = torch.onnx.export(
        whole, (example,), input_names=[ROW], output_names=[PROBABILITY],
        dynamic_shapes=({0: torch.export.Dim("rows")},), dynamo=True, verbose=False,
    )  # fmt: skip
    assert program is not None  # it is None with dynamo=False only
    return program.model_proto


def _estimator(model: Any) -> "ModelProto":
    from onnx.utils import Extractor
    from skl2onnx import convert_sklearn
    from skl2onnx.common.data_types import FloatTensorType
    from skl2onnx.common.exceptions import MissingConverter, MissingShapeCalculator
    from sklearn.preprocessing import FunctionTransformer

    try:
        proto = convert_sklearn(
            model,
            initial_types=[(ROW, FloatTensorType([None, model.n_features_in_]))],
            final_types=[("label", None), (PROBABILITY, None)],
            options={"zipmap": False},
            custom_conversion_functions={FunctionTransformer: _asinh},
            custom_shape_calculators={FunctionTransformer: _as_before},
        )
    except (MissingConverter, MissingShapeCalculator, ValueError) as error:
        reason = str(error)[:LONGEST_REASON]  # one that skl2onnx gives may hold all trees
        raise ValueError(f"{type(model).__name__} cannot become ONNX, take another classifier: {reason}") from error
    return Extractor(proto).extract_model([ROW], [PROBABILITY])


def _asinh(scope: Any, operator: Any, container: Any) -> None:
    """The node for :func:`learn.methods.strong.compression`, the only function in the project's pipelines."""
    function = operator.raw_operator.func
    if function is not np.arcsinh:
        raise ValueError(f"the function {function} of a pipeline cannot become ONNX: only np.arcsinh can")
    name = scope.get_unique_operator_name("Asinh")
    container.add_node("Asinh", operator.inputs[0].full_name, operator.outputs[0].full_name, name=name, op_version=9)


def _as_before(operator: Any) -> None:
    operator.outputs[0].type = operator.inputs[0].type
