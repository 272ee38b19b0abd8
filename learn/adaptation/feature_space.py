"""Feature space for comparison of rows: features of the source network, or standardised inputs."""

from collections.abc import Callable
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.inputs.rows import as_tensor
from learn.methods.neural import NeuralClassifier

Space = Callable[[np.ndarray], np.ndarray]  # (row, column) to (row, feature)


def feature_space(source: Any, kept: Float[np.ndarray, "row column"]) -> Space:
    """Map from rows to features.

    Parameters
    ----------
    source : fitted classifier
    kept : array (row, column)
        Rows of the source gears, by which inputs are standardised if the source model is not a network.
    """
    if isinstance(source, NeuralClassifier):
        return lambda X: _embedded(source, X)
    centre, scale = kept.mean(axis=0), kept.std(axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    return lambda X: (X - centre) / scale


def _embedded(source: NeuralClassifier, X: np.ndarray) -> np.ndarray:
    import torch

    from learn.methods.training import one_thread

    network = source.network_.eval()
    rows = as_tensor(X).to(network.centre.device)
    with torch.inference_mode(), one_thread():
        return np.asarray(network.embed(rows).cpu().double().numpy())
