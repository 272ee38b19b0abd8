"""Neural networks as classifiers with scikit-learn's contract, and their files.

PyTorch is imported inside the functions, because all commands import this module for its factories.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from learn.inputs.rows import Inputs, Rows, as_tensor, chunks
from learn.methods.archive import require_plain
from swgsim.common.files import replacing
from swgsim.common.seeds import generator

if TYPE_CHECKING:
    from torch import Tensor

    from learn.methods.networks import Architecture, Network
    from learn.methods.training import Recipe

SUFFIX = ".pt"  # of the files
SCALED = 30_000  # largest number of rows for the scaling; more rows would not change it


@dataclass(eq=False)
class NeuralClassifier:
    """A network and its training recipe.

    Attributes
    ----------
    architecture : Architecture
    recipe : Recipe
    seed : int
        Seed of the initial weights and of training.
    device : str
        ``auto``, ``cpu`` or ``cuda``.
    classes_ : array (class,)
        Sorted names of the classes; set by :meth:`fit`.
    network_ : Network
        Set by :meth:`fit`.
    """

    architecture: "Architecture"
    recipe: "Recipe"
    seed: int = 0
    device: str = "auto"
    classes_: np.ndarray = field(init=False, repr=False)
    network_: "Network" = field(init=False, repr=False)

    def fit(self, X: Inputs, y: np.ndarray) -> "NeuralClassifier":
        """Train a new network on rows and their class names, from which the scaling comes too.

        Raises
        ------
        ValueError
            If a number is not finite, or there is only one class.
        """
        import torch

        from learn.methods.training import choose_device, train

        _require_finite(X)
        classes, numbers = np.unique(y, return_inverse=True)
        if len(classes) < 2:
            raise ValueError(f"the rows have {len(classes)} class ({', '.join(map(str, classes))}), 2 are needed")
        network = self.architecture.network(X.shape[1], len(classes), self.seed)
        network.set_scaling(self._sample(X))
        network.to(choose_device(self.device))
        train(network, X if isinstance(X, Rows) else as_tensor(X), torch.from_numpy(numbers), self.recipe, self.seed)
        self.classes_, self.network_ = classes, network
        return self

    def predict_proba(self, X: Inputs) -> Float[np.ndarray, "row class"]:
        """Probability of each class of ``classes_``.

        Raises
        ------
        ValueError
            If a number is not finite, the number of columns differs from training, or the network is not trained.
        """
        import torch

        from learn.methods.training import one_thread

        if not hasattr(self, "network_"):
            raise ValueError("this neural classifier is not trained: call fit first, or load one")
        _require_finite(X)
        centre = self.network_.centre
        if X.shape[1] != len(centre):
            raise ValueError(f"rows have {X.shape[1]} columns, the network was trained with {len(centre)}")
        self.network_.eval()
        with torch.inference_mode(), one_thread():
            logits = [self.network_(as_tensor(rows).to(centre.device)) for rows in chunks(X)]
            return np.asarray(torch.cat(logits).cpu().double().softmax(dim=1).numpy())

    def predict(self, X: Inputs) -> np.ndarray:
        """Most probable class of each row."""
        most_probable = self.predict_proba(X).argmax(axis=1)
        return self.classes_[most_probable]

    def _sample(self, X: Inputs) -> Float[np.ndarray, "some column"]:
        """All rows, or SCALED random ones."""
        if len(X) <= SCALED:
            return np.asarray(X)
        return np.asarray(X[np.sort(generator("scaling", self.seed).choice(len(X), SCALED, replace=False))])

    def with_network(self, network: "Network") -> "NeuralClassifier":
        """A copy of the classifier with another network for the same classes."""
        other = replace(self)
        other.classes_, other.network_ = self.classes_, network
        return other


def neural_perceptron(
    channels: int = 0, points: int = 0, periodic: bool = True, layers: int = 2, neurons: int = 256,
    dropout: float = 0.4, epochs: int = 20, batch: int = 256, rate: float = 2e-3, decay: float = 0.1, steps: int = 0,
    seed: int = 0, device: str = "auto",
) -> NeuralClassifier:  # fmt: skip
    """A perceptron; see :func:`learn.methods.networks.perceptron` and :class:`learn.methods.training.Recipe`."""
    from learn.methods.networks import Architecture
    from learn.methods.training import Recipe

    signal = {"channels": channels, "points": points, "periodic": periodic}
    options = {**signal, "layers": layers, "neurons": neurons, "dropout": dropout}
    return NeuralClassifier(
        Architecture("perceptron", options), Recipe(epochs, batch, rate, decay, steps), seed, device
    )


def convolutional_network(
    channels: int, points: int, periodic: bool = True, width: int = 32, dropout: float = 0.3, epochs: int = 15,
    batch: int = 256, rate: float = 3e-3, decay: float = 1e-2, steps: int = 0, seed: int = 0, device: str = "auto",
    kind: str = "convolutional",
) -> NeuralClassifier:  # fmt: skip
    """Convolutions over the angle; see :func:`networks.convolutional` and :class:`training.Recipe`."""
    from learn.methods.networks import Architecture
    from learn.methods.training import Recipe

    signal = {"channels": channels, "points": points, "periodic": periodic}
    options = {**signal, "width": width, "dropout": dropout}
    return NeuralClassifier(Architecture(kind, options), Recipe(epochs, batch, rate, decay, steps), seed, device)


residual_network = partial(convolutional_network, kind="residual")


def set_network(
    channels: int = 0, points: int = 0, periodic: bool = False, neurons: int = 128, dropout: float = 0.3,
    epochs: int = 40, batch: int = 256, rate: float = 2e-3, decay: float = 0.1, steps: int = 0, seed: int = 0,
    device: str = "auto",
) -> NeuralClassifier:  # fmt: skip
    """A network on joint rows; see :func:`learn.methods.networks.set_network` and :class:`.training.Recipe`.

    Raises
    ------
    ValueError
        If the rows are no joint rows.
    """
    if periodic or not channels:
        raise ValueError(
            "the set network needs all recordings of a specimen in a row: take rows=unit features=harmonics of swg "
            "train, or learn.inputs.joint_rows"
        )
    from learn.methods.networks import Architecture
    from learn.methods.training import Recipe

    options = {"channels": channels, "points": points, "neurons": neurons, "dropout": dropout}
    return NeuralClassifier(Architecture("set", options), Recipe(epochs, batch, rate, decay, steps), seed, device)


def save(model: NeuralClassifier, path: Path) -> None:
    """Write a trained classifier with weights, scaling and class names."""
    import torch

    content = {
        "architecture": {"kind": model.architecture.kind, "options": dict(model.architecture.options)},
        "columns": len(model.network_.centre),
        "classes": [str(name) for name in model.classes_],
        "recipe": asdict(model.recipe),
        "seed": model.seed,
        "state": {name: value.cpu() for name, value in model.network_.state_dict().items()},
    }
    # Through an open file, as PyTorch writes the name of a path into the file.
    with replacing(path) as aside, aside.open("wb") as raw:
        torch.save(content, raw)


def load(path: Path, device: str = "auto") -> NeuralClassifier:
    """Read a classifier from a file of :func:`save` without running code from the file.

    Raises
    ------
    ValueError
        If it is another file.
    """
    import torch

    from learn.methods.networks import Architecture
    from learn.methods.training import Recipe, choose_device

    try:
        content = _content(path)
        architecture = Architecture(**content["architecture"])
        model = NeuralClassifier(architecture, Recipe(**content["recipe"]), content["seed"], device)
        model.classes_ = np.array(content["classes"])
        with torch.device("meta"):  # without memory, as a small file may describe a large network
            model.network_ = architecture.network(content["columns"], len(model.classes_), model.seed)
        _require_state(content["state"], model.network_.state_dict())
        model.network_.load_state_dict(content["state"], assign=True)
    except Exception as error:  # PyTorch raises many kinds
        raise ValueError(f"{path} is no neural classifier: give a file of learn.methods.neural.save") from error
    model.network_.to(choose_device(device)).eval()
    return model


def _content(path: Path) -> Mapping[str, Any]:
    """Content of a sound archive; a bare pickle is refused."""
    import torch

    require_plain(path)
    with path.open("rb") as raw:
        content: Mapping[str, Any] = torch.load(raw, map_location="cpu", weights_only=True)
    return content


def _require_state(given: Mapping[str, "Tensor"], needed: Mapping[str, "Tensor"]) -> None:
    """Raise unless all needed tensors are given with their types and shapes, and finite."""
    for name, like in needed.items():
        value = given[name]
        if value.dtype != like.dtype or value.shape != like.shape or not value.is_contiguous():
            raise ValueError(f"{name} is {value.dtype} of shape {tuple(value.shape)}, must be {tuple(like.shape)}")
        if not value.isfinite().all():
            raise ValueError(f"{name} has numbers that are not finite")


def _require_finite(X: Inputs) -> None:
    start = 0
    for rows in chunks(X):
        bad = np.argwhere(~np.isfinite(rows))
        if len(bad):
            row, column = bad[0]
            raise ValueError(
                f"column {column} of row {start + row} is {rows[row, column]}: leave out or fill in missing values"
            )
        start += len(rows)
