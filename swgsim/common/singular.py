"""The singular value decomposition, also where the quick way of LAPACK fails."""

import numpy as np
import scipy.linalg


def svd(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """U, s and V' of a matrix (row, column), as many of each as the shorter side has.

    LAPACK's gesdd, which NumPy takes, does not converge for some ordinary matrices, with some builds of OpenBLAS and
    numbers of threads (https://github.com/OpenMathLib/OpenBLAS/issues/3044); gesvd does, and takes twice the time.
    """
    try:
        return np.linalg.svd(A, full_matrices=False)
    except np.linalg.LinAlgError:
        return scipy.linalg.svd(A, full_matrices=False, lapack_driver="gesvd")
