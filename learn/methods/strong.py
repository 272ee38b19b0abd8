"""Strong classical methods beside the paper's five; each is a scikit-learn estimator with ``predict_proba``."""

from typing import TYPE_CHECKING

import numpy as np

from learn.methods.contract import Classifier

if TYPE_CHECKING:
    from sklearn.pipeline import Pipeline


def logistic_regression(strength: float = 1.0, iterations: int = 300, seed: int = 0) -> Classifier:
    """Multinomial logistic regression on compressed features; `strength` is the inverse of the regularisation, C."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline

    regression = LogisticRegression(C=strength, max_iter=iterations, random_state=seed)
    return make_pipeline(compression(), regression)


def compression() -> "Pipeline":
    """Features scaled by median and quartiles and compressed by asinh.

    A severe fault is hundreds of times the noise that a mild one stands in.
    """
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import FunctionTransformer, RobustScaler

    return make_pipeline(RobustScaler(), FunctionTransformer(np.arcsinh))


def gradient_boosting(
    rounds: int = 300, rate: float = 0.05, leaves: int = 15, columns: float = 0.3, seed: int = 0
) -> Classifier:
    """Histogram gradient boosting; every split considers a random share `columns` of the features."""
    from sklearn.ensemble import HistGradientBoostingClassifier

    return HistGradientBoostingClassifier(
        max_iter=rounds, learning_rate=rate, max_leaf_nodes=leaves, max_features=columns, random_state=seed,
        early_stopping=False,  # which would set rows aside whose specimens are trained on
    )  # fmt: skip


def extra_trees(trees: int = 100, smallest_leaf: int = 1, columns: float | str = 0.3, seed: int = 0) -> Classifier:
    """Extremely randomised trees at full depth; every split considers a share `columns` of the features."""
    from sklearn.ensemble import ExtraTreesClassifier

    return ExtraTreesClassifier(trees, min_samples_leaf=smallest_leaf, max_features=columns, random_state=seed)
