"""The singular value decomposition has a second way."""

import numpy as np
import pytest

from swgsim.common.singular import svd


def fails(*_, **__):
    """What NumPy does where gesdd does not converge."""
    raise np.linalg.LinAlgError("SVD did not converge")


@pytest.mark.parametrize("shape", [(40, 7), (7, 40)])
def test_both_ways_give_the_same(monkeypatch, shape):
    A = np.random.default_rng(1).normal(size=shape)
    quick = svd(A)
    monkeypatch.setattr(np.linalg, "svd", fails)
    sure = svd(A)
    for U, s, Vt in (quick, sure):
        assert (U.shape, s.shape, Vt.shape) == ((shape[0], 7), (7,), (7, shape[1]))
        np.testing.assert_allclose(U * s @ Vt, A, atol=1e-12)
    np.testing.assert_allclose(sure[1], quick[1])
