"""The five classifiers of Table VI as scikit-learn estimators; other settings are scikit-learn's defaults.

As in the paper, none of them scales its features.
"""

from learn.methods.contract import Classifier


def multi_layer_perceptron(
    hidden_layers: int = 3, neurons: int = 10, iterations: int = 200, seed: int = 0
) -> Classifier:
    """Multi-layer perceptron (MLP) with ReLU units and at most `iterations` epochs.

    The metric ``converged`` reports whether the optimiser ended before; 200 epochs are scikit-learn's default.
    """
    from sklearn.neural_network import MLPClassifier

    return MLPClassifier((neurons,) * hidden_layers, activation="relu", max_iter=iterations, random_state=seed)


def support_vector_machine(kernel: str = "rbf", C: float = 1.0) -> Classifier:
    """Support vector machine (SVM) with a kernel of scikit-learn; `C` is the weight of a row of training."""
    from sklearn.svm import SVC

    return SVC(C=C, kernel=kernel)


def random_forest(trees: int = 100, depth: int = 7, seed: int = 0) -> Classifier:
    """Random forest (RF) of `trees` trees with at most `depth` levels."""
    from sklearn.ensemble import RandomForestClassifier

    return RandomForestClassifier(trees, max_depth=depth, random_state=seed)


def nearest_neighbours(neighbours: int = 3) -> Classifier:
    """Nearest neighbours (KNN): majority of the `neighbours` nearest rows."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(neighbours)


def naive_bayes() -> Classifier:
    """Naive Bayes (NB) with a Gaussian for each class and feature."""
    from sklearn.naive_bayes import GaussianNB

    return GaussianNB()
