"""Singular value decomposition, also where the fast method of LAPACK fails."""

import numpy as np
import scipy.linalg


def svd(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Thin singular value decomposition U, s, V' of a matrix (row, column).

    NumPy's gesdd does not converge for some ordinary matrices with some builds of OpenBLAS and numbers of threads
    (https://github.com/OpenMathLib/OpenBLAS/issues/3044). Then gesvd is used, which takes twice the time.
    """
    try:
        return np.linalg.svd(A, full_matrices=False)
    except np.linalg.LinAlgError:
        return scipy.linalg.svd(A, full_matrices=False, lapack_driver="gesvd")
