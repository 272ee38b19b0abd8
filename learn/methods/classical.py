"""The five classifiers of Table VI, with scikit-learn's standard settings otherwise, on features as they are.

Like the paper, none scales its features. Each is a scikit-learn estimator: ``fit(X, y)`` and ``predict(X)``.
"""

from learn.methods.contract import Classifier


def multi_layer_perceptron(
    hidden_layers: int = 3, neurons: int = 10, iterations: int = 200, seed: int = 0
) -> Classifier:
    """MLP with ReLU units.

    `iterations` bounds the epochs; 200 is scikit-learn's standard. Whether the optimiser came to an end before is
    reported as the metric ``converged``.
    """
    from sklearn.neural_network import MLPClassifier

    return MLPClassifier((neurons,) * hidden_layers, activation="relu", max_iter=iterations, random_state=seed)


def support_vector_machine(kernel: str = "rbf") -> Classifier:
    """SVM with one of scikit-learn's kernels."""
    from sklearn.svm import SVC

    return SVC(kernel=kernel)


def random_forest(trees: int = 100, depth: int = 7, seed: int = 0) -> Classifier:
    """RF of `trees` trees of at most `depth` levels."""
    from sklearn.ensemble import RandomForestClassifier

    return RandomForestClassifier(trees, max_depth=depth, random_state=seed)


def nearest_neighbours(neighbours: int = 3) -> Classifier:
    """KNN with the majority of the nearest `neighbours`."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(neighbours)


def naive_bayes() -> Classifier:
    """NB with a Gaussian per class and feature."""
    from sklearn.naive_bayes import GaussianNB

    return GaussianNB()
