"""Simpler methods, on the same fit and the same signatures as the loop."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.common.chi2_logsf import surprise
from swgsim.common.singular import svd
from swgsim.effects.base import Effect
from swgsim.identification.decide.prior import MOST_CAUSES
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import Hypothesis, hypotheses, signatures
from swgsim.identification.search.screening import ALPHA


class Task(NamedTuple):
    """The hypotheses, their signatures, and the fit without any of them."""

    found: Sequence[Hypothesis]
    signatures: Sequence[Float[np.ndarray, "row column"]]
    fitted: Fitted


def named_by_baselines(fitted: Fitted, kinds: Sequence[type[Effect]]) -> dict[str, list[str]]:
    """Names that every baseline gives, the first one first."""
    found = list(hypotheses(kinds))
    if not found:
        return {name: [] for name in BASELINES}
    task = Task(found, signatures(found, fitted.model, fitted.measured), fitted)
    return {name: list(dict.fromkeys(method(task))) for name, method in BASELINES.items()}


def calibration_only(task: Task) -> list[str]:
    """The declared parameters are fitted, and that is all."""
    return []


def correlation(task: Task) -> list[str]:
    """The signature most like the residual, with no regard to what calibration has already taken out of it."""
    white, r = task.fitted.errors.whiten, task.fitted.errors.whiten(task.fitted.residual)
    best, name, tried = 0.0, [], len(task.found)
    for hypothesis, signature in zip(task.found, task.signatures, strict=True):
        basis = _basis(white(signature))
        rank = surprise(float(((basis.T @ r) ** 2).sum()), basis.shape[1])
        if rank > best and rank > -2 * np.log(ALPHA / tried):
            best, name = rank, [hypothesis.kind.name()]
    return name


def bic_forward(task: Task) -> list[str]:
    """Linear steps forward as long as Schwarz's criterion falls, the declared parameters being open; no other test."""
    white = task.fitted.whole.whiten
    r = white(task.fitted.from_start)
    left = [white(signature) for signature in task.signatures]
    named = []
    for _ in range(MOST_CAUSES):
        gains = []
        for columns in left:
            basis = _basis(columns)
            gains.append(float(((basis.T @ r) ** 2).sum()) - basis.shape[1] * np.log(len(r)))
        best = int(np.argmax(gains))
        if gains[best] <= 0:
            break
        named.append(task.found[best].kind.name())
        basis = _basis(left[best])
        r = r - basis @ (basis.T @ r)
        left = [columns - basis @ (basis.T @ columns) for columns in left]
    return named


def sparse_regression(task: Task) -> list[str]:
    """Orthogonal matching pursuit of the residual with signatures of equal length, as deep as cross-validation says."""
    from sklearn.linear_model import OrthogonalMatchingPursuitCV

    white = task.fitted.errors.whiten(np.hstack(list(task.signatures)))
    r = task.fitted.errors.whiten(task.fitted.residual)
    owner = np.repeat(np.arange(len(task.found)), [s.shape[1] for s in task.signatures])
    length = np.linalg.norm(white, axis=0)
    seen = length > 1e-9 * length.max()
    order = np.random.default_rng(0).permutation(len(r))
    X = (white[:, seen] / length[seen])[order]
    fitted = OrthogonalMatchingPursuitCV(max_iter=2 * MOST_CAUSES, cv=5, fit_intercept=False).fit(X, r[order])
    largest = np.argsort(-np.abs(fitted.coef_))[: np.count_nonzero(fitted.coef_)]
    # The first step is always taken; alone and unable to pay on other rows, it names nothing.
    if len(largest) == 1 and _held_out_reduction(X, r[order], int(largest[0])) <= 0:
        return []
    return [task.found[owner[seen][i]].kind.name() for i in largest]


def _held_out_reduction(X: np.ndarray, r: np.ndarray, column: int) -> float:
    """What one column takes off the squares of the second half of the rows, fitted to the first half."""
    half = len(r) // 2
    x = X[:, column]
    scale = float(x[:half] @ r[:half] / max(float(x[:half] @ x[:half]), 1e-300))
    return float((r[half:] ** 2).sum() - ((r[half:] - scale * x[half:]) ** 2).sum())


def _basis(columns: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row rank"]:
    """Orthonormal directions, without those that are rounding."""
    U, s, _ = svd(columns)
    return U[:, s > 1e-6 * max(float(s.max()), 1e-3)]


BASELINES: Mapping[str, Callable[[Task], list[str]]] = {
    "calibration_only": calibration_only,
    "correlation": correlation,
    "bic_forward": bic_forward,
    "sparse_regression": sparse_regression,
}
