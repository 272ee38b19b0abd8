"""Rows of features with the tails that severe faults give them, and their classes."""

import numpy as np


def heavy_tailed(rows=2600, columns=50, decades=3.0):
    """Features in single precision whose units are up to `decades` powers of ten apart, and class names."""
    from sklearn.datasets import make_classification

    X, y = make_classification(
        rows, columns, n_informative=12, n_redundant=8, n_classes=6, class_sep=1.5, flip_y=0.05, random_state=1
    )
    units = 10 ** np.random.default_rng(0).uniform(-decades, decades, columns)
    return (np.sinh(X) * units).astype(np.float32), np.array(list("ABCDEF"))[y]
