"""Standard deviations of the errors of single recordings, from repeats, or from all recordings without repeats."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize

from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import DOUBT, Scatter

# Bounds of the logarithm of a standard deviation relative to the known one: 7 and 5 times its doubt. They only keep the
# search away from numbers that are too small or too large to compute with (estimates).
RATIOS = (-8.0, 6.0)
# The search ends where a step gains less than this share, or where no slope is larger [nat]: every standard deviation
# then lies within 0.1 % of its maximum, which is known to some per cent at best.
FLAT, SLOPE = 1e-9, 1e-3
# Difference for the curvature, in the logarithm.
STEP = 1e-3


class Statistics(NamedTuple):
    """Sufficient statistics of errors that change data by B; noise has the covariance V, and parts are independent.

    Attributes
    ----------
    K : array (part, error, error)
        B' V^-1 B.
    F : array (part, error, column)
        B' V^-1 X of columns X: other nuisance parameters, one standard deviation each, and the residual as the last.
    H : array (column, column)
        X' V^-1 X of all parts together.
    """

    K: Float[np.ndarray, "part error error"]
    F: Float[np.ndarray, "part error column"]
    H: Float[np.ndarray, "column column"]


def from_repeats(
    residual: Float[np.ndarray, "recording feature"],
    noise: RecordingCovariance,
    directions: Float[np.ndarray, "recording feature kind"],
    trends: Float[np.ndarray, "recording feature column"],
    groups: Sequence[object],
    known: Scatter,
) -> Scatter:
    """Maximum of the posterior of the standard deviations, from the repeats within each group (restricted likelihood).

    Changes that all recordings have in common, or that follow temperature, time or load, may be lack of fit. They are
    projected out.

    Parameters
    ----------
    residual : array (recording, feature)
        Measured minus predicted.
    noise : RecordingCovariance
        All other errors of single recordings; alike in repeats, except for the size of its variance.
    directions : array (recording, feature, kind)
    trends : array (recording, feature, column)
        Errors that recordings share, one standard deviation each.
    groups : sequence
        Recordings of the same value are repeats of each other.
    known : Scatter
    """
    contrasts, of_recording = _helmert(groups)
    if not len(contrasts):
        return known
    columns = np.tensordot(contrasts, np.concatenate([trends, residual[..., None]], axis=-1), axes=1)
    of_contrasts = RecordingCovariance(contrasts**2 @ noise.variance, noise.C[of_recording])
    white = of_contrasts.whiten(np.vstack(np.concatenate([directions[of_recording], columns], axis=-1)))
    split = white.reshape(*columns.shape[:2], -1)
    kinds = directions.shape[-1]
    return _likeliest(_statistics(split[..., :kinds], split[..., kinds:]), known, len(contrasts))


def _helmert(groups: Sequence[object]) -> tuple[Float[np.ndarray, "contrast recording"], list[int]]:
    """Contrasts of the repeats of each group, independent of each other and of the mean, and the recording of each
    whose directions stand for it.
    """
    contrasts, last = [], []
    for group in dict.fromkeys(groups):
        rows = [i for i, each in enumerate(groups) if each == group]
        for number in range(1, len(rows)):
            weights = np.zeros(len(groups))
            weights[rows[:number]] = -1 / np.sqrt(number * (number + 1))
            weights[rows[number]] = np.sqrt(number / (number + 1))
            contrasts.append(weights)
            last.append(rows[number])
    return np.reshape(contrasts, (-1, len(groups))), last


def from_all(
    residual: Float[np.ndarray, " row"],
    common: Covariance,
    directions: Float[np.ndarray, "recording feature kind"],
    trends: Float[np.ndarray, "recording feature column"],
    known: Scatter,
) -> Scatter:
    """Maximum of the posterior of the standard deviations, from all recordings.

    It is used without repeats. Lack of fit then looks like scatter and has less weight.

    Parameters
    ----------
    residual : array (row,)
        Measured less predicted where the spreads begin; rows (recording, feature).
    common : Covariance
        All other errors, those of fitted parameters among them (restricted likelihood).
    directions : array (recording, feature, kind)
    trends : array (recording, feature, column)
        Errors that recordings share, one standard deviation each.
    known : Scatter
    """
    common = common.with_columns(trends.reshape(len(residual), -1))
    B = common.whiten(RecordingCovariance(common.alone.variance, directions).dense)
    return _likeliest(_statistics(B[None], common.whiten(residual)[None, :, None]), known, 0)


def _statistics(B: Float[np.ndarray, "part row error"], X: Float[np.ndarray, "part row column"]) -> Statistics:
    """Sufficient statistics of whitened data."""
    across = B.transpose(0, 2, 1)
    return Statistics(across @ B, across @ X, np.tensordot(X, X, ((0, 1), (0, 1))))


def _likeliest(statistics: Statistics, known: Scatter, contrasts: int) -> Scatter:
    known_sd, precision = np.array(list(known.sd.values())), np.linalg.inv(known.doubt)
    kinds = len(known_sd)
    K, F, H = statistics
    H = H + np.diag(np.append(np.ones(len(H) - 1), 0.0))

    def cost(log_ratio: np.ndarray) -> tuple[float, np.ndarray]:
        slope = precision @ log_ratio
        total = 0.5 * float(log_ratio @ slope)
        s = np.tile(known_sd * np.exp(log_ratio), K.shape[1] // kinds)[:, None]
        # X' (V + B S^2 B')^-1 X of all columns, where S holds the standard deviations.
        inner = np.linalg.inv(np.eye(len(s)) + s * K * s.T)
        half = inner @ (s * F)
        within = H - np.tensordot(s * F, half, ((0, 1), (0, 1)))
        total -= 0.5 * float(np.linalg.slogdet(inner)[1].sum())
        spread = np.linalg.inv(within[:-1, :-1])
        left = np.append(-spread @ within[:-1, -1], 1.0)
        total += 0.5 * float(left @ within @ left - np.linalg.slogdet(spread)[1])
        by = np.outer(left, left)
        by[:-1, :-1] += spread
        of_errors = 1 - np.diagonal(inner, axis1=1, axis2=2) - (half @ by * half).sum(axis=-1)
        return total, slope + of_errors.reshape(-1, kinds).sum(axis=0)

    fitted = minimize(
        cost, np.zeros(kinds), jac=True, method="L-BFGS-B", bounds=[RATIOS] * kinds,
        options={"ftol": FLAT, "gtol": SLOPE, "maxiter": 500},
    )  # fmt: skip
    sd = dict(zip(known.sd, (known_sd * np.exp(fitted.x)).tolist(), strict=True))
    return Scatter(sd, known.repeats + contrasts, _doubt(lambda x: cost(x)[1], fitted.x))


def _doubt(slope: Callable[[np.ndarray], np.ndarray], x: Float[np.ndarray, " kind"]) -> Float[np.ndarray, "kind kind"]:
    """Inverse of the curvature (Laplace), at least that of the prior."""
    here = slope(x)
    curvature = np.array([(slope(x + by) - here) / STEP for by in STEP * np.eye(len(x))])
    values, vectors = np.linalg.eigh((curvature + curvature.T) / 2)
    return (vectors / np.maximum(values, 1 / DOUBT**2)) @ vectors.T
