"""Classical methods that the paper does not have, as scikit-learn estimators."""

from typing import TYPE_CHECKING

import numpy as np

from learn.methods.contract import Classifier

if TYPE_CHECKING:
    from sklearn.pipeline import Pipeline


def logistic_regression(strength: float = 1.0, iterations: int = 300, seed: int = 0) -> Classifier:
    """Multinomial logistic regression on compressed features; `strength` C is the inverse of the regularisation."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline

    regression = LogisticRegression(C=strength, max_iter=iterations, random_state=seed)
    return make_pipeline(compression(), regression)


def compression() -> "Pipeline":
    """Scaling by median and quartiles, then asinh, as a severe fault exceeds the noise hundreds of times."""
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
        early_stopping=False,  # it would hold out rows of trained specimens
    )  # fmt: skip


def extra_trees(trees: int = 100, smallest_leaf: int = 1, columns: float | str = 0.3, seed: int = 0) -> Classifier:
    """Extremely randomised trees at full depth; every split considers a share `columns` of the features."""
    from sklearn.ensemble import ExtraTreesClassifier

    return ExtraTreesClassifier(trees, min_samples_leaf=smallest_leaf, max_features=columns, random_state=seed)
