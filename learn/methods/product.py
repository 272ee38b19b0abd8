"""The posterior of a unit from those of its recordings: their product."""

import numpy as np
from jaxtyping import Float, Int
from scipy.special import softmax

# Lower bound of probabilities in logarithms, as a forest may give a class no vote.
SMALLEST = 1e-6


def product(
    probabilities: Float[np.ndarray, "row class"], unit: Int[np.ndarray, " row"]
) -> Float[np.ndarray, "row class"]:
    """Posterior of the unit of each row, by all recordings of the unit.

    Classes are equally frequent, so that the posterior of independent recordings is the product of theirs. Recordings
    of a session share the bias of the torque flanges, which this ignores: the product is too sure of itself.

    Parameters
    ----------
    probabilities : array (row, class)
        Of single recordings; those below 1e-6 count as 1e-6.
    unit : array (row,)
        Number of the unit of each row.

    >>> product(np.array([[0.4, 0.6], [0.9, 0.1], [0.5, 0.5]]), np.array([7, 7, 3])).round(3).tolist()
    [[0.857, 0.143], [0.857, 0.143], [0.5, 0.5]]
    """
    _, number = np.unique(unit, return_inverse=True)
    total = np.zeros((number.max(initial=-1) + 1, probabilities.shape[1]))
    np.add.at(total, number, np.log(np.maximum(probabilities, SMALLEST)))
    return np.asarray(softmax(total, axis=1)[number])
