"""Covariance of the errors of single recordings: noise, and errors that are correlated within one recording."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float


@dataclass(frozen=True, eq=False)
class RecordingCovariance:
    """diag(variance) + C C^T within every recording; rows (recording, feature) of a residual, one below the other.

    Attributes
    ----------
    variance : array (recording, feature)
        Of the independent errors.
    C : array (recording, feature, kind)
        Errors of each recording, one standard deviation each.
    """

    variance: Float[np.ndarray, "recording feature"]
    C: Float[np.ndarray, "recording feature kind"]

    @classmethod
    def white(cls, variance: Float[np.ndarray, "recording feature"]) -> "RecordingCovariance":
        """Independent errors only."""
        return cls(variance, np.zeros((*variance.shape, 0)))

    def beside(self, C: Float[np.ndarray, "recording feature kind"]) -> "RecordingCovariance":
        """The same with more errors, which become the first ones."""
        return RecordingCovariance(self.variance, np.concatenate([C, self.C], axis=-1))

    @cached_property
    def _shares(self) -> tuple[Float[np.ndarray, "recording feature kind"], Float[np.ndarray, "recording kind 1"]]:
        """Q and r for which diag(1 / variance) - Q Q' is the inverse, and, with both sides in units of the independent
        errors, 1 - Q r / (1 + r) Q' its symmetric root.
        """
        scaled = self.C / np.sqrt(self.variance)[..., None]
        eigenvalues, V = np.linalg.eigh(scaled.transpose(0, 2, 1) @ scaled)
        r = np.sqrt(1 + np.maximum(eigenvalues, 0))  # what rounding makes of them shrinks nothing
        return self.C / self.variance[..., None] @ (V / r[:, None, :]), r[..., None]

    def whiten(self, X: np.ndarray) -> np.ndarray:
        """W X with W covariance W' = 1, for an array (row,) or (row, column)."""
        Q, r = self._shares
        split = self._split(X)
        found = split / self.variance[..., None]
        found -= Q @ (r / (1 + r) * (Q.transpose(0, 2, 1) @ split))
        found *= np.sqrt(self.variance)[..., None]
        return found.reshape(X.shape)

    def weigh(self, X: np.ndarray) -> np.ndarray:
        """P X with P the inverse of the covariance, for an array (row,) or (row, column)."""
        Q, _ = self._shares
        split = self._split(X)
        found = split / self.variance[..., None]
        found -= Q @ (Q.transpose(0, 2, 1) @ split)
        return found.reshape(X.shape)

    def precision(self, block: Bool[np.ndarray, " row"]) -> Float[np.ndarray, "block block"]:
        """The block of P of some of the rows."""
        Q, _ = self._shares
        inside = block.reshape(self.variance.shape)
        found = np.diag(1 / self.variance[inside])
        ends = np.cumsum([0, *inside.sum(axis=1)])
        for start, end, rows, share in zip(ends, ends[1:], inside, Q, strict=False):
            found[start:end, start:end] -= share[rows] @ share[rows].T
        return found

    @property
    def log_determinant(self) -> float:
        """Of the covariance."""
        return float(np.log(self.variance).sum() + 2 * np.log(self._shares[1]).sum())

    def divergence(self, other: "RecordingCovariance") -> float:
        """Kullback-Leibler divergence from the other covariance to this one, as the mean over recordings [nat]."""
        Q, _ = other._shares
        C = self.C.reshape(self.variance.size, -1)
        trace = (self.variance / other.variance).sum() - (Q**2 * self.variance[..., None]).sum()
        trace += (C * other.weigh(C)).sum()
        excess = trace - self.variance.size + other.log_determinant - self.log_determinant
        return float(excess) / (2 * len(self.variance))

    def made(self, errors: np.ndarray) -> np.ndarray:
        """What errors (recording and kind,), in standard deviations, make of the rows; or each of several."""
        recordings, features, kinds = self.C.shape
        split = errors.reshape(recordings, kinds, *errors.shape[1:] or (1,))
        return (self.C @ split).reshape(recordings * features, *errors.shape[1:])

    @property
    def dense(self) -> Float[np.ndarray, "row error"]:
        """All errors as columns of their own; most of it is nothing."""
        recordings, _, kinds = self.C.shape
        return self.made(np.eye(recordings * kinds))

    def recordings(self, chosen: Bool[np.ndarray, " recording"]) -> "RecordingCovariance":
        """Of some of the recordings."""
        return RecordingCovariance(self.variance[chosen], self.C[chosen])

    def _split(self, X: np.ndarray) -> np.ndarray:
        """Rows by recording (recording, feature, column)."""
        return X.reshape(*self.variance.shape, -1)
