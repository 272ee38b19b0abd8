"""Evaluation of all methods: fit and score on each split."""

import inspect
import time
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from learn.inputs.inputs import OPERATING_POINT, SPECIMEN
from learn.inputs.rows import Inputs
from learn.methods.contract import Classifier
from learn.protocols.splits import Split

FACTS = [*SPECIMEN, "severity", *OPERATING_POINT]


@dataclass(frozen=True)
class SplitScore:
    """Accuracy in training and test [%], time to fit [s] and to judge a row [ms]; whether the optimiser converged."""

    name: str
    train: float
    test: float
    fit_seconds: float
    milliseconds: float
    converged: bool


@dataclass(frozen=True)
class Evaluation:
    """Scores of one method.

    Attributes
    ----------
    scores : tuple of SplitScore
        One per split.
    classes : tuple of str
        Names of the classes in the order of the data set, which is that of the confusion matrix.
    confusion : array (true, predicted)
        Number of tested rows, summed over the splits.
    tested : array (test,)
        Row numbers of the tested rows, split by split.
    probabilities : array (test, class)
        Predicted probabilities; a method without probabilities counts as certain.
    """

    scores: tuple[SplitScore, ...]
    classes: tuple[str, ...]
    confusion: Int[np.ndarray, "true predicted"]
    tested: Int[np.ndarray, " test"]
    probabilities: Float[np.ndarray, "test class"]

    def predictions(self, table: pd.DataFrame) -> pd.DataFrame:
        """Facts of the tested rows, and one column per class with its probability."""
        facts = table.loc[self.tested, FACTS].reset_index(names="row")
        predicted = pd.DataFrame(self.probabilities.astype("f4"), columns=list(self.classes))
        return facts.assign(label=facts["label"].astype(str)).join(predicted)

    @property
    def mean_test_score(self) -> float:
        """Accuracy in test, the mean over splits [%]."""
        return float(np.mean([score.test for score in self.scores]))

    def recall(self) -> Mapping[str, float]:
        """Recall of each tested class [%]."""
        tested = self.confusion.sum(axis=1)
        return {
            name: 100 * float(self.confusion[i, i] / tested[i]) for i, name in enumerate(self.classes) if tested[i] > 0
        }

    def metrics(self) -> dict[str, float]:
        """All metrics, rounded to three decimals; scores are means over splits [%]."""
        recall = self.recall()
        exact = {
            "train_score": float(np.mean([s.train for s in self.scores])),
            "test_score": self.mean_test_score,
            "balanced_accuracy": float(np.mean(list(recall.values()))),
            "fit_seconds": sum(s.fit_seconds for s in self.scores),
            "milliseconds": float(np.mean([s.milliseconds for s in self.scores])),
            "converged": float(all(s.converged for s in self.scores)),
            **{f"test/{metric_key(s.name)}": s.test for s in self.scores},
            **{f"recall/{name}": value for name, value in recall.items()},
        }
        return {name: round(value, 3) for name, value in exact.items()}


def metric_key(split: str) -> str:
    """Name of a split in the name of a metric, which must not contain ``,`` or ``>``.

    >>> metric_key("1,2->3")
    '1_2_to_3'
    """
    return split.replace(",", "_").replace("->", "_to_").replace(" ", "_")


def evaluate(
    features: Inputs,
    labels: np.ndarray,
    splits: Iterable[Split],
    method: Callable[[], Classifier],
    gears: np.ndarray | None = None,
) -> Evaluation:
    """Train a new classifier on the training rows of every split, and score it in training and test.

    Parameters
    ----------
    features : array (row, feature)
    labels : array (row,)
        Class names.
    splits : iterable of Split
    method : callable
        Returns an untrained classifier.
    gears : array (row,), optional
        Gear of every row, for methods that leave gears out while they are trained.
    """
    classes = pd.Index(pd.unique(labels))
    confusion = np.zeros((len(classes), len(classes)), dtype=np.int64)
    scores, tested, predictions = [], [], []
    for split in splits:
        classifier = method()
        start = time.perf_counter()
        converged = fit(
            classifier, features[split.train], labels[split.train], None if gears is None else gears[split.train]
        )
        seconds = time.perf_counter() - start
        probabilities = _probabilities(classifier, features[split.test], classes)
        milliseconds = 1000 * (time.perf_counter() - start - seconds) / max(len(split.test), 1)
        truth = classes.get_indexer(labels[split.test])
        predicted = probabilities.argmax(axis=1)
        np.add.at(confusion, (truth, predicted), 1)
        train_score = np.mean(classifier.predict(features[split.train]) == labels[split.train])
        test_score = np.mean(predicted == truth)
        found = 100 * float(train_score), 100 * float(test_score), seconds, milliseconds, converged
        scores.append(SplitScore(split.name, *found))
        tested.append(split.test)
        predictions.append(probabilities)
    return Evaluation(
        tuple(scores), tuple(map(str, classes)), confusion, np.concatenate(tested), np.concatenate(predictions)
    )


def _probabilities(classifier: Classifier, X: Inputs, classes: pd.Index) -> Float[np.ndarray, "row class"]:
    """Probability of every class; 1 for the decision of a method without probabilities."""
    result = np.zeros((len(X), len(classes)))
    if hasattr(classifier, "predict_proba") and hasattr(classifier, "classes_"):
        result[:, classes.get_indexer(pd.Index(classifier.classes_))] = classifier.predict_proba(X)
    else:
        result[np.arange(len(X)), classes.get_indexer(pd.Index(classifier.predict(X)))] = 1
    return result


def fit(classifier: Classifier, features: Inputs, labels: np.ndarray, gears: np.ndarray | None = None) -> bool:
    """Fit, and return whether the optimiser converged, instead of a warning.

    The gear of every row is passed on to a classifier whose ``fit`` has an argument ``gears``.
    """
    from sklearn.exceptions import ConvergenceWarning

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ConvergenceWarning)
        asked = gears is not None and "gears" in inspect.signature(classifier.fit).parameters
        classifier.fit(features, labels, **({"gears": gears} if asked else {}))
    for other in caught:
        if not issubclass(other.category, ConvergenceWarning):
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)
    return not any(issubclass(each.category, ConvergenceWarning) for each in caught)
