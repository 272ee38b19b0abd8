"""Files of trained models, from which all adaptations of a source model start.

:mod:`learn.methods.neural` stores networks, skops stores scikit-learn's estimators; reading them runs no code.
"""

import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from learn.evaluation.evaluate import fit
from learn.methods import neural
from learn.methods.archive import require_plain
from swgsim.common.files import replacing, sole_maker

# Further types that skops may read: parts of estimators that hold arrays and numbers.
TRUSTED = [
    "aeon.transformations.collection.convolution_based._minirocket.MiniRocket",
    "learn.methods.rocket.MiniRocket",
    "sklearn.ensemble._hist_gradient_boosting.predictor.TreePredictor",
    "sklearn.neural_network._stochastic_optimizers.AdamOptimizer",
    "sklearn.tree._tree.Tree",
]


def save(model: Any, path: Path) -> None:
    """Write a trained classifier to a file, which is complete or absent."""
    if isinstance(model, neural.NeuralClassifier):
        neural.save(model, path)
        return
    import skops.io

    with replacing(path) as aside:
        skops.io.dump(model, aside)


def load(path: Path, device: str = "auto") -> Any:
    """Read a classifier from a file of :func:`save`, a network to the named device.

    Raises
    ------
    ValueError
        If the file is damaged, a pickle, or contains other types.
    """
    if path.suffix == neural.SUFFIX:
        return neural.load(path, device)
    import skops.io

    try:
        require_plain(path)
        return skops.io.load(path, trusted=TRUSTED)
    except Exception as error:  # skops raises many kinds
        raise ValueError(
            f"{path}: not a model of this project, or damaged ({error}); remove it to train anew"
        ) from error


def trained(
    folder: Path, identity: str, model: Any, X: np.ndarray, y: np.ndarray, gears: np.ndarray | None = None
) -> Any:
    """The model trained on these rows, from its file in the folder or else trained and stored.

    Classifiers of other packages than this one and scikit-learn are not stored.

    Parameters
    ----------
    folder : Path
    identity : str
        Everything else that affects the result: configuration, code, libraries.
    model : classifier
        Untrained.
    X, y : array (row, column), array (row,)
    gears : array (row,), optional
        Gear of every row, for a model that leaves gears out while it is trained.
    """
    kind = type(model)
    if (
        kind.__module__.partition(".")[0] not in ("learn", "sklearn")
        and f"{kind.__module__}.{kind.__name__}" not in TRUSTED
    ):
        fit(model, X, y, gears)
        return model
    digest = hashlib.sha256(identity.encode())
    digest.update(np.ascontiguousarray(X).data)
    digest.update("\x1f".join(map(str, y)).encode())
    digest.update("\x1f".join(map(str, () if gears is None else gears)).encode())
    is_network = isinstance(model, neural.NeuralClassifier)
    path = folder / f"{digest.hexdigest()[:24]}{neural.SUFFIX if is_network else '.skops'}"
    # Jobs of a sweep with the same source model start together; the first one trains it.
    with sole_maker(path, wait=True):
        if not path.exists():
            fit(model, X, y, gears)
            save(model, path)
    return load(path, model.device if is_network else "auto")
