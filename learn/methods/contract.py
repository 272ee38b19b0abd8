"""The contract of classifiers, and its check for a class that is not part of this project."""

import hashlib
import inspect
import pkgutil
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from learn.inputs.rows import Inputs

METHODS = {"fit": "fit(X, y)", "predict": "predict(X)", "predict_proba": "predict_proba(X)"}
TRIAL_ROWS = 24
TRIAL_CLASSES = np.array(["healthy", "reduced_damping", "tip_tooth_crack"])


@runtime_checkable
class Classifier(Protocol):
    """A classifier with the contract of scikit-learn.

    A class of your own is chosen by its import path: ``PYTHONPATH=folder swg train classifier=module:Class``, where
    ``folder`` holds the module. The protocol has two methods only, because the paper's support vector machine has no
    ``predict_proba``: each of its decisions counts as certain. A class of your own needs four things:

    ``fit(X, y)``
        Trains on features X, float array (row, feature), and class names y, str array (row,). With an argument
        ``gears`` it is also given the gear of every row, for choices that leave gears out.
    ``predict(X)``
        Class name of each row, array (row,).
    ``predict_proba(X)``
        Probability of each class, array (row, class). Columns are in the order of ``classes_``, rows sum to 1.
    ``classes_``
        Sorted names of the classes in y, array (class,); set by ``fit``.

    Options are arguments of ``__init__``: ``classifier.option=value``. If ``__init__`` has the arguments
    ``channels``, ``points`` and ``periodic``, it receives the :class:`learn.inputs.inputs.Layout` of the signal with
    which each row begins. Data sets of 100 000 recordings and more arrive as :class:`learn.inputs.rows.Rows`, which
    ``np.asarray(X)`` reads.

    Not every adaptation takes such a class. ``prototypes`` does. ``coral`` and ``from_scratch`` do if it derives from
    ``sklearn.base.BaseEstimator``. Those of networks take ``learn.methods.NeuralClassifier`` only, those
    of forests the forests of scikit-learn only.

    Examples
    --------
    >>> class NearestMean:
    ...     def fit(self, X, y):
    ...         self.classes_ = np.unique(y)
    ...         self.means = np.array([X[y == name].mean(axis=0) for name in self.classes_])
    ...     def predict_proba(self, X):
    ...         closeness = 1 / (1e-9 + np.linalg.norm(X[:, None] - self.means, axis=2))
    ...         return closeness / closeness.sum(axis=1, keepdims=True)
    ...     def predict(self, X):
    ...         return self.classes_[self.predict_proba(X).argmax(axis=1)]
    >>> require_contract("module:NearestMean", NearestMean, columns=5)
    """

    def fit(self, X: Inputs, y: np.ndarray) -> object:
        """Train on features and class names."""
        ...

    def predict(self, X: Inputs) -> np.ndarray:
        """Class name of each row."""
        ...


def believed_classes(y: np.ndarray, believed: Sequence[str]) -> np.ndarray:
    """Sorted names of the classes in y, for a classifier that simulates the faults of a grid.

    Raises
    ------
    ValueError
        If a class is not among those of the grid.
    """
    classes = np.unique(y)
    unknown = sorted(set(classes) - set(believed))
    if unknown:
        raise ValueError(f"class {str(unknown[0])!r} is not among the classes of the believed grid: add it there")
    return classes


def is_import_path(name: str) -> bool:
    """Whether a name is an import path ``module:Class`` and not a built-in classifier."""
    return ":" in name


def class_of(path: str) -> type:
    """The class with the import path ``module:Class``.

    Raises
    ------
    ValueError
        If there is no such class, or it lacks a method of :class:`Classifier`; the message lists all that is missing.
    """
    try:
        found = pkgutil.resolve_name(path)
    except (ImportError, AttributeError, ValueError) as error:
        raise ValueError(
            f"classifier {path!r} cannot be imported: {error}. Give module:Class, with the folder of the module on "
            "PYTHONPATH"
        ) from error
    if not isinstance(found, type):
        raise ValueError(f"classifier {path!r} is a {type(found).__name__}, a class is needed")
    missing = [call for name, call in METHODS.items() if not callable(getattr(found, name, None))]
    if missing:
        raise _violation(path, f"it has no {', no '.join(missing)}")
    return found


def require_contract(path: str, make: Callable[[], Any], columns: int) -> None:
    """Raise unless a classifier keeps the contract on a few rows of noise; the features of a job come later.

    Parameters
    ----------
    path : str
        Import path, for the messages.
    make : callable
        Makes an untrained classifier.
    columns : int
        Number of features.

    Raises
    ------
    ValueError
        If a method fails, or returns something else than :class:`Classifier` says.
    """
    X = np.random.default_rng(0).standard_normal((TRIAL_ROWS, columns))
    y = TRIAL_CLASSES[np.arange(TRIAL_ROWS) % len(TRIAL_CLASSES)]
    step = "__init__"
    try:
        classifier = make()
        step = METHODS["fit"]
        classifier.fit(X.copy(), y.copy())
        step = METHODS["predict_proba"]
        probabilities = np.asarray(classifier.predict_proba(X.copy()))
        step = METHODS["predict"]
        names = np.asarray(classifier.predict(X.copy()))
    except Exception as error:
        raise ValueError(
            f"classifier {path!r}: {step} failed in the trial before training, on {TRIAL_ROWS} rows of {columns} "
            f"features: {type(error).__name__}: {error}"
        ) from error
    classes = getattr(classifier, "classes_", None)
    if classes is None:
        raise _violation(path, "fit sets no attribute classes_")
    if np.asarray(classes).tolist() != TRIAL_CLASSES.tolist():
        raise _violation(path, f"classes_ is {_listed(classes)} for the class names {_listed(TRIAL_CLASSES)}")
    shape = (TRIAL_ROWS, len(TRIAL_CLASSES))
    if probabilities.shape != shape:
        raise _violation(path, f"predict_proba(X) has shape {probabilities.shape}, expected {shape} (row, class)")
    if not (np.all(probabilities >= 0) and np.allclose(probabilities.sum(axis=1), 1, atol=1e-3)):
        raise _violation(path, "predict_proba(X) has rows that are not probabilities: each must be >= 0 and sum to 1")
    if names.shape != shape[:1] or not set(names.tolist()) <= set(TRIAL_CLASSES.tolist()):
        raise _violation(path, f"predict(X) gives {_listed(names.ravel()[:3])}, expected one class name for each row")


def _listed(values: Iterable[Any]) -> str:
    return "[" + ", ".join(map(str, values)) + "]"


def _violation(path: str, fact: str) -> ValueError:
    return ValueError(
        f"classifier {path!r}: {fact}. A classifier needs {', '.join(METHODS.values())} and, after fit, classes_; "
        "see learn.methods.Classifier"
    )


def own_source_digests(config: Mapping[str, Any]) -> list[str]:
    """Digests of the source of a classifier of one's own, for the key of a job; empty for a built-in classifier.

    Parameters
    ----------
    config : mapping
        Resolved configuration of ``conf/train.yaml``.

    Returns
    -------
    list of str
        One digest: of the module, or of all modules of its package if the import path has a dot. Other modules that
        the class imports are not covered.
    """
    path = str(config.get("classifier", {}).get("name"))
    if not is_import_path(path):
        return []
    class_of(path)
    module = path.partition(":")[0]
    file = Path(inspect.getfile(sys.modules[module]))
    depth = module.count(".") + (file.name == "__init__.py")
    digest = hashlib.sha256()
    for source in sorted(file.parents[depth - 1].rglob("*.py")) if depth else [file]:
        digest.update(source.read_bytes())
    return [digest.hexdigest()[:16]]


def with_own_classifier(words: Sequence[str]) -> list[str]:
    """The words of a command with ``classifier=module:Class`` in the spelling of Hydra, which knows files only.

    >>> with_own_classifier(["grid=small", "classifier=my_net:Net", "classifier.width=8"])
    ['grid=small', 'classifier=own', 'classifier.name=my_net:Net', '++classifier.width=8']
    >>> with_own_classifier(["classifier=rf", "classifier.trees=10"])
    ['classifier=rf', 'classifier.trees=10']
    """
    path = next((word.removeprefix("classifier=") for word in words if word.startswith("classifier=")), "")
    if not is_import_path(path):
        return list(words)
    spelled = []
    for word in words:
        if word == f"classifier={path}":
            spelled += ["classifier=own", f"classifier.name={path}"]
        else:
            spelled.append(f"++{word}" if word.startswith("classifier.") else word)
    return spelled
