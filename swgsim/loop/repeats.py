"""How large the errors of single recordings are: repeats tell it, or all recordings where nothing was ever repeated."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize

from swgsim.loop.gaussian import Covariance
from swgsim.loop.scatter import DOUBT, Scatter, covariance


class Told(NamedTuple):
    """What numbers with known noise say of errors: by as many numbers as there are errors, kind after kind.

    Attributes
    ----------
    K : array (error, error)
        B' V^-1 B for errors that move what was measured by B, in noise of covariance V.
    b : array (error,)
        B' V^-1 r of the residual r.
    """

    K: Float[np.ndarray, "error error"]
    b: Float[np.ndarray, " error"]


def from_repeats(
    residual: Float[np.ndarray, "recording feature"],
    variance: Float[np.ndarray, "recording feature"],
    directions: Float[np.ndarray, "recording feature kind"],
    groups: Sequence[object],
    known: Scatter,
) -> Scatter:
    """The standard deviations that the repeats within each group are likeliest with, given what was known before.

    Parameters
    ----------
    residual : array (recording, feature)
        Measured less predicted.
    variance : array (recording, feature)
        Of the white noise.
    directions : array (recording, feature, kind)
    groups : sequence
        Recordings of the same value are repeats of each other.
    known : Scatter
    """
    contrasts = []
    for group in dict.fromkeys(groups):
        rows = [i for i, each in enumerate(groups) if each == group]
        for number in range(1, len(rows)):
            # Helmert contrasts: independent of each other and of the mean.
            weights = np.zeros(len(residual))
            weights[rows[:number]] = -1 / np.sqrt(number * (number + 1))
            weights[rows[number]] = np.sqrt(number / (number + 1))
            B = directions[rows[number]]
            weighted = B / (weights**2 @ variance)[:, None]
            contrasts.append(Told(weighted.T @ B, weighted.T @ (weights @ residual)))
    return _likeliest(contrasts, known, len(contrasts)) if contrasts else known


def from_all(
    residual: Float[np.ndarray, " row"],
    common: Covariance,
    directions: Float[np.ndarray, "recording feature kind"],
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
    known : Scatter
    """
    B = common.whiten(covariance(common.variance.reshape(directions.shape[:2]), directions).G)
    return _likeliest([Told(B.T @ B, B.T @ common.whiten(residual))], known, 0)


def _likeliest(told: Sequence[Told], known: Scatter, contrasts: int) -> Scatter:
    known_sd, precision = np.array(list(known.sd.values())), np.linalg.inv(known.doubt)
    kinds = len(known_sd)

    def cost(log_ratio: np.ndarray) -> tuple[float, np.ndarray]:
        slope = precision @ log_ratio
        total = 0.5 * float(log_ratio @ slope)
        for K, b in told:
            s = np.tile(known_sd * np.exp(log_ratio), len(b) // kinds)
            # log det(I + S K S) - b' S (I + S K S)^-1 S b, and its slope over log s.
            scaled = s[:, None] * K * s
            inner = np.linalg.inv(np.eye(len(s)) + scaled)
            half = inner @ (s * b)
            total += -0.5 * np.linalg.slogdet(inner)[1] - 0.5 * float((s * b) @ half)
            each = (1 - np.diag(inner)) - half * (s * b) + half * (scaled @ half)
            slope = slope + each.reshape(-1, kinds).sum(axis=0)
        return total, slope

    fitted = minimize(
        cost, np.zeros(kinds), jac=True, method="L-BFGS-B", bounds=[(-8, 6)] * kinds,
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
