"""How large the errors of single recordings are: repeats tell it, or all recordings where nothing was ever repeated."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize

from swgsim.loop.alone import Alone
from swgsim.loop.gaussian import Covariance
from swgsim.loop.scatter import DOUBT, Scatter

# Logarithms of the ratio to the known one between which a standard deviation is sought: 7 and 5 times as far as the
# stated one is doubted, so they only keep the search from numbers too small or large to compute with (estimates).
RATIOS = (-8.0, 6.0)


class Told(NamedTuple):
    """What numbers with noise of covariance V say of errors, kind after kind, that move them by B.

    Attributes
    ----------
    K : array (error, error)
        B' V^-1 B.
    F : array (error, column)
        B' V^-1 X of columns X: what else may move these numbers, one standard deviation each, and the residual, last.
    H : array (column, column)
        X' V^-1 X.
    """

    K: Float[np.ndarray, "error error"]
    F: Float[np.ndarray, "error column"]
    H: Float[np.ndarray, "column column"]


def from_repeats(
    residual: Float[np.ndarray, "recording feature"],
    variance: Float[np.ndarray, "recording feature"],
    directions: Float[np.ndarray, "recording feature kind"],
    trends: Float[np.ndarray, "recording feature column"],
    groups: Sequence[object],
    known: Scatter,
) -> Scatter:
    """The standard deviations that the repeats within each group are likeliest with, given what was known before.

    What all recordings have in common, or follows temperature, time or load, may be what the model lacks, and tells
    nothing of them (restricted likelihood).

    Parameters
    ----------
    residual : array (recording, feature)
        Measured less predicted.
    variance : array (recording, feature)
        Of the white noise.
    directions : array (recording, feature, kind)
    trends : array (recording, feature, column)
        Errors that are none of single recordings, one standard deviation each.
    groups : sequence
        Recordings of the same value are repeats of each other.
    known : Scatter
    """
    columns = np.concatenate([trends, residual[..., None]], axis=-1)
    contrasts = []
    for group in dict.fromkeys(groups):
        rows = [i for i, each in enumerate(groups) if each == group]
        for number in range(1, len(rows)):
            # Helmert contrasts: independent of each other and of the mean.
            weights = np.zeros(len(residual))
            weights[rows[:number]] = -1 / np.sqrt(number * (number + 1))
            weights[rows[number]] = np.sqrt(number / (number + 1))
            B = directions[rows[number]]
            contrasts.append(_told(B, np.tensordot(weights, columns, axes=1), weights**2 @ variance))
    return _likeliest(contrasts, known, len(contrasts)) if contrasts else known


def from_all(
    residual: Float[np.ndarray, " row"],
    common: Covariance,
    directions: Float[np.ndarray, "recording feature kind"],
    trends: Float[np.ndarray, "recording feature column"],
    known: Scatter,
) -> Scatter:
    """The standard deviations that all recordings are likeliest with, given what was known before.

    For recordings of which none is repeated. What the model lacks can pass for scatter here, and so weighs less.

    Parameters
    ----------
    residual : array (row,)
        Measured less predicted where the spreads begin; rows (recording, feature).
    common : Covariance
        All other errors, those of fitted parameters among them (restricted likelihood).
    directions : array (recording, feature, kind)
    trends : array (recording, feature, column)
        Errors that are none of single recordings, one standard deviation each.
    known : Scatter
    """
    common = common.with_columns(trends.reshape(len(residual), -1))
    B = common.whiten(Alone(common.alone.variance, directions).dense)
    return _likeliest([_told(B, common.whiten(residual)[:, None], np.ones(len(residual)))], known, 0)


def _told(
    B: Float[np.ndarray, "row error"], X: Float[np.ndarray, "row column"], variance: Float[np.ndarray, " row"]
) -> Told:
    """What numbers tell whose noise is independent."""
    weighted = X / variance[:, None]
    return Told(B.T @ (B / variance[:, None]), B.T @ weighted, X.T @ weighted)


def _likeliest(told: Sequence[Told], known: Scatter, contrasts: int) -> Scatter:
    known_sd, precision = np.array(list(known.sd.values())), np.linalg.inv(known.doubt)
    kinds = len(known_sd)
    H = np.sum([each.H for each in told], axis=0)
    H[:-1, :-1] += np.eye(len(H) - 1)

    def cost(log_ratio: np.ndarray) -> tuple[float, np.ndarray]:
        slope = precision @ log_ratio
        total = 0.5 * float(log_ratio @ slope)
        sd = known_sd * np.exp(log_ratio)
        # X' (V + B S^2 B')^-1 X of all columns, where S holds the standard deviations.
        within, halves = H.copy(), []
        for K, F, _ in told:
            s = np.tile(sd, len(K) // kinds)[:, None]
            inner = np.linalg.inv(np.eye(len(s)) + s * K * s.T)
            half = inner @ (s * F)
            within -= (s * F).T @ half
            total -= 0.5 * np.linalg.slogdet(inner)[1]
            slope = slope + (1 - np.diag(inner)).reshape(-1, kinds).sum(axis=0)
            halves.append(half)
        spread = np.linalg.inv(within[:-1, :-1])
        left = np.append(-spread @ within[:-1, -1], 1.0)
        total += 0.5 * (float(left @ within @ left) - np.linalg.slogdet(spread)[1])
        by = np.outer(left, left)
        by[:-1, :-1] += spread
        for half in halves:
            slope = slope - (half @ by * half).sum(axis=1).reshape(-1, kinds).sum(axis=0)
        return total, slope

    fitted = minimize(
        cost, np.zeros(kinds), jac=True, method="L-BFGS-B", bounds=[RATIOS] * kinds,
        options={"ftol": 1e-14, "gtol": 1e-6, "maxiter": 500},
    )  # fmt: skip
    sd = dict(zip(known.sd, (known_sd * np.exp(fitted.x)).tolist(), strict=True))
    return Scatter(sd, known.repeats + contrasts, _doubt(lambda x: cost(x)[1], fitted.x))


def _doubt(slope: Callable[[np.ndarray], np.ndarray], x: Float[np.ndarray, " kind"]) -> Float[np.ndarray, "kind kind"]:
    """Inverse of the curvature (Laplace), which is at least that of what was stated."""
    step = 1e-3
    moved = step * np.eye(len(x))
    curvature = np.array([(slope(x + by) - slope(x - by)) / (2 * step) for by in moved])
    values, vectors = np.linalg.eigh((curvature + curvature.T) / 2)
    return (vectors / np.maximum(values, 1 / DOUBT**2)) @ vectors.T
