"""Networks and regressions as layers: compression, convolutions with their normalisation folded in, dense layers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from learn.methods.neural import NeuralClassifier

if TYPE_CHECKING:
    from learn.methods.networks import Network


@dataclass(frozen=True)
class Dense:
    """``bias + weight @ input``, rectified or not; a filter of a convolution has its channels and taps in a row."""

    weight: Float[np.ndarray, "row column"]
    bias: Float[np.ndarray, " row"]
    rectified: bool


@dataclass(frozen=True)
class Layers:
    """Computation of a classifier.

    Attributes
    ----------
    centre, spread : array (column,) or None
        The row is compressed to ``asinh((row - centre) / spread)``; None: it is not compressed.
    dense : tuple of Dense
        The layers at the end; the last one gives logits.
    blocks : tuple of (channels, Dense)
        Convolutions with stride 2 over the signal, if any, with the channels of their inputs.
    auxiliary : Dense or None
        Layer of the columns after the signal.
    """

    centre: Float[np.ndarray, " column"] | None
    spread: Float[np.ndarray, " column"] | None
    dense: tuple[Dense, ...]
    blocks: tuple[tuple[int, Dense], ...] = ()
    auxiliary: Dense | None = None
    channels: int = 0
    points: int = 0


def layers_of(model: Any) -> Layers:
    """The layers of a trained logistic regression, multi-layer perceptron or network of this project.

    Raises
    ------
    ValueError
        If the model has another type.
    """
    from sklearn.linear_model import LogisticRegression
    from sklearn.neural_network import MLPClassifier
    from sklearn.pipeline import Pipeline

    if isinstance(model, NeuralClassifier):
        return _network(model.network_, model.architecture.kind)
    if isinstance(model, MLPClassifier):
        last = len(model.coefs_) - 1
        pairs = enumerate(zip(model.coefs_, model.intercepts_, strict=True))
        return Layers(None, None, tuple(Dense(weight.T, bias, i < last) for i, (weight, bias) in pairs))
    if isinstance(model, Pipeline) and isinstance(model[-1], LogisticRegression):
        scaler, regression = model[0][0], model[-1]
        return Layers(scaler.center_, scaler.scale_, (Dense(regression.coef_, regression.intercept_, False),))
    raise ValueError(f"{type(model).__name__} has no layers: give a logistic regression, a perceptron or a network")


def _network(network: "Network", kind: str) -> Layers:
    state = {name: value.double().cpu().numpy() for name, value in network.state_dict().items()}

    def dense(name: str, rectified: bool) -> Dense:
        return Dense(state[f"{name}.weight"], state[f"{name}.bias"], rectified)

    head = dense("head", False)
    centre, spread = state["centre"], state["scale"]
    if kind == "perceptron":
        hidden = [name.removesuffix(".weight") for name in state if name.startswith("body") and name.endswith("weight")]
        return Layers(centre, spread, (*(dense(name, True) for name in hidden), head))
    if kind != "convolutional":
        raise ValueError(f"a {kind} network has no form in C: give a perceptron or a convolutional network")
    body: Any = network.body
    if "body.side.0.weight" not in state or body.blocks[0].padding_mode != "circular":
        raise ValueError("this convolutional network has no front end in C: train it with features=residual")
    blocks = tuple(_folded(state, number) for number in (0, 3, 6))  # convolution, normalisation, ReLU
    last = (dense("body.joined.1", True), head)
    return Layers(centre, spread, last, blocks, dense("body.side.0", True), body.channels, body.points)


def _folded(state: Mapping[str, np.ndarray], number: int) -> tuple[int, Dense]:
    """A convolution with the normalisation behind it, as one."""
    weight, norm = state[f"body.blocks.{number}.weight"], f"body.blocks.{number + 1}."
    factor = state[norm + "weight"] / np.sqrt(state[norm + "running_var"] + 1e-5)  # PyTorch's own guard against 0
    bias = state[norm + "bias"] - factor * state[norm + "running_mean"]
    flat = (weight * factor[:, None, None]).reshape(len(weight), -1)
    return weight.shape[1], Dense(flat, bias, True)
