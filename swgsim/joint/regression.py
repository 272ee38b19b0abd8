"""Weights of terms by least squares over many recordings, and their errors in cross-validation."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import lsq_linear
from scipy.signal import butter, sosfiltfilt
from scipy.stats import t

from swgsim.common.singular import svd
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term

# Corner frequency of the slow part of a residual [Hz]: gravity, inertia and friction are below, ripples above.
SLOW = 5.0
# Length of a stretch [s]; errors of different stretches count as independent.
STRETCH = 1.0
# Relative reduction of a cross-validated error that is worth a term.
LEAST_GAIN = 0.005
# Groups for the cross-validation of a single recording.
FOLDS = 5


@dataclass(frozen=True, eq=False)
class Table:
    """One signal of some recordings, all their samples in rows.

    Attributes
    ----------
    recordings : tuple of JointRecording
    of : str
        Name of the signal to explain.
    trust : array (row,) or None
        Factors of the rows in least squares: standard deviation of the noise over that of the row's error. None: all
        rows have the same.
    """

    recordings: tuple[JointRecording, ...]
    of: str
    trust: Float[np.ndarray, " row"] | None = None

    def __post_init__(self) -> None:
        lacking = [each.name for each in self.recordings if self.of not in each.signals]
        if lacking or not self.recordings:
            raise ValueError(
                f"no recording has the signal {self.of}" if not self.recordings else
                f"recording {lacking[0]} has no signal {self.of}: leave it out, or choose another signal"
            )  # fmt: skip

    @cached_property
    def signal(self) -> Float[np.ndarray, " row"]:
        """The signal to explain, times ``trust``; of a torque sensor without the zero of each run."""
        return self.rows([each.signals[self.of][:, None] for each in self.recordings])[:, 0]

    def columns(self, term: Term) -> Float[np.ndarray, "row column"]:
        """Columns of a term, treated like the signal."""
        return self.rows([term.columns(each) for each in self.recordings])

    def columns_by_group(self, term: Term) -> Float[np.ndarray, "row column"]:
        """Columns of a term of which those of one group depend on that group only, for cross-validation."""
        parts = [self.recordings[0].part(rows) for rows in self.parts] if len(self.recordings) == 1 else []
        if not (term.of_whole and parts and all(map(term.possible, parts))):
            return self.columns(term)
        return self.rows([np.vstack([term.columns(part) for part in parts])])

    def rows(self, each: Sequence[Float[np.ndarray, "_ column"]]) -> Float[np.ndarray, "row column"]:
        """Columns of all recordings, times ``trust``; for a torque sensor the mean of each run is removed."""
        whole = np.vstack(list(each)) if self.trust is None else self.trust[:, None] * np.vstack(list(each))
        return whole - self.means_of_runs(whole) if self.of == "T_sensor" else whole

    @cached_property
    def run(self) -> Int[np.ndarray, " row"]:
        """Number of the recording of every row."""
        return np.repeat(np.arange(len(self.recordings)), [len(each) for each in self.recordings])

    @cached_property
    def session(self) -> Int[np.ndarray, " row"]:
        """Number of the session of every row."""
        sessions = list(dict.fromkeys(each.session for each in self.recordings))
        return np.array([sessions.index(each.session) for each in self.recordings])[self.run]

    @cached_property
    def group(self) -> Int[np.ndarray, " row"]:
        """Number of the group of every row for cross-validation: a run, or a part of a single run."""
        return self.run if len(self.recordings) > 1 else np.arange(len(self.run)) * FOLDS // len(self.run)

    def means_of_runs(self, values: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row column"]:
        """Mean of each run, in all its rows; of values that have the factor ``trust``, as the result has."""
        by = np.ones(len(values)) if self.trust is None else self.trust
        sums = np.stack([np.bincount(self.run, by * column) for column in values.T], axis=1)
        return (sums / np.bincount(self.run, by**2)[:, None])[self.run] * by[:, None]

    @cached_property
    def parts(self) -> list[slice]:
        """Rows of every group."""
        starts = np.flatnonzero(np.diff(self.group, prepend=-1)).tolist()
        return [slice(a, b) for a, b in zip(starts, [*starts[1:], len(self.group)], strict=True)]

    @cached_property
    def stretch(self) -> Int[np.ndarray, " row"]:
        """Number of the stretch of every row."""
        found, first = [], 0
        for each in self.recordings:
            number = np.floor((each.time - each.time[0]) / STRETCH).astype(int)
            found.append(first + number)
            first += int(number[-1]) + 1
        return np.concatenate(found)


@dataclass(frozen=True, eq=False)
class Fit:
    """Terms with their weights.

    Attributes
    ----------
    table : Table
        Fitted recordings.
    terms : tuple of Term
        With weights.
    X : array (row, column)
        Columns of all terms.
    bounded : bool
        Whether the weights are kept at or above their smallest possible values.
    """

    table: Table
    terms: tuple[Term, ...]
    X: Float[np.ndarray, "row column"]
    bounded: bool = True

    @cached_property
    def least(self) -> Float[np.ndarray, " column"]:
        """Smallest possible weights of all columns."""
        every = [term.least(len(term.weights)) for term in self.terms]
        return np.concatenate(every) if self.bounded else np.full(self.X.shape[1], -np.inf)

    @cached_property
    def weights(self) -> Float[np.ndarray, " column"]:
        """Weights of all columns."""
        return np.concatenate([term.weights for term in self.terms])

    @cached_property
    def residual(self) -> Float[np.ndarray, " row"]:
        """Measured minus predicted, times the trust in each row."""
        return self.table.signal - self.X @ self.weights

    @cached_property
    def basis(self) -> Float[np.ndarray, "row rank"]:
        """Orthonormal directions of all columns whose weight is free to change: not at its smallest value."""
        X = self.X[:, self.weights > self.least]
        U, s, _ = svd(X / _scale(X))
        return U[:, s > 1e-9 * s.max()]

    @property
    def error(self) -> float:
        """Root mean square of measured minus predicted, in the unit of the signal."""
        return rms(self.residual if self.table.trust is None else self.residual / self.table.trust)

    @cached_property
    def unseen(self) -> Float[np.ndarray, " row"]:
        """Residual of every group, predicted by a fit to the other groups."""
        return self._unseen(self._by_group, self.table.signal)

    @cached_property
    def unseen_but_zeros(self) -> Float[np.ndarray, " row"]:
        """The same if the signal of each run had a zero of its own, which is known."""
        X, y = self._by_group, self.table.signal
        return self._unseen(X - self.table.means_of_runs(X), y - self.table.means_of_runs(y[:, None])[:, 0])

    @cached_property
    def _by_group(self) -> Float[np.ndarray, "row column"]:
        """Columns of which those of one group depend on that group only."""
        if any(term.of_whole for term in self.terms):
            return np.hstack([self.table.columns_by_group(term) for term in self.terms])
        return self.X

    def _unseen(self, X: Float[np.ndarray, "row column"], y: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
        scaled, parts = X / _scale(X), self.table.parts
        squares = [scaled[part].T @ scaled[part] for part in parts]
        products = [scaled[part].T @ y[part] for part in parts]
        square, product = sum(squares), sum(products)
        # With scaled columns the normal equations are accurate enough.
        return np.concatenate([
            y[part] - scaled[part] @ _solved(square - own, product - other, self.least)
            for part, own, other in zip(parts, squares, products, strict=True)
        ])  # fmt: skip

    @cached_property
    def half_interval(self) -> Float[np.ndarray, " column"]:
        """Half of the 95 % interval of every weight, for errors that are correlated within a stretch only."""
        return self.half_intervals(np.eye(self.X.shape[1]))

    def half_intervals(self, sums: Float[np.ndarray, "sum column"]) -> Float[np.ndarray, " sum"]:
        """The same of sums of weights, each given by the factors of the weights."""
        scale = _scale(self.X)
        inverse = np.linalg.pinv((self.X / scale).T @ (self.X / scale), hermitian=True)
        stretches = int(self.table.stretch.max()) + 1
        scores = np.zeros((stretches, self.X.shape[1]))
        np.add.at(scores, self.table.stretch, self.X / scale * self.residual[:, None])
        spread = np.linalg.norm(scores @ inverse @ (sums / scale).T, axis=0)
        return float(t.ppf(0.975, max(stretches - 1, 1))) * spread

    def missed(self, other: Table) -> Float[np.ndarray, " row"]:
        """Residual on other recordings."""
        return other.signal - sum(other.columns(term) @ np.array(term.weights) for term in self.terms)


def fit(table: Table, terms: Sequence[Term], *, bounded: bool = True) -> Fit:
    """The weights of terms by least squares, each at or above its smallest possible value if ``bounded``."""
    columns = [table.columns(term) for term in terms]
    X = np.hstack(columns)
    weights = solved(X, table.signal)
    least = np.concatenate([term.least(own.shape[1]) for term, own in zip(terms, columns, strict=True)])
    if bounded and (weights < least).any():
        scaled = X / _scale(X)
        weights = _solved(scaled.T @ scaled, scaled.T @ table.signal, least) / _scale(X)
    each = np.split(weights, np.cumsum([own.shape[1] for own in columns])[:-1])
    found = tuple(term.weighted(own) for term, own in zip(terms, each, strict=True))
    return Fit(table, found, X, bounded)


def solved(X: Float[np.ndarray, "row column"], y: Float[np.ndarray, " row"]) -> Float[np.ndarray, " column"]:
    """Weights of columns by least squares; equal columns share their weight."""
    scale = _scale(X)
    return np.linalg.lstsq(X / scale, y, rcond=1e-9)[0] / scale


def slow(table: Table, residual: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """The part of a residual below SLOW; the whole residual of a recording that is too coarse or too short."""
    found = residual.copy()
    for number, each in enumerate(table.recordings):
        if each.rate > 4 * SLOW and len(each) > 100:
            own = table.run == number
            found[own] = sosfiltfilt(butter(4, SLOW, fs=each.rate, output="sos"), residual[own])
    return found


def rms(values: Float[np.ndarray, " row"]) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def _solved(
    square: Float[np.ndarray, "column column"], product: Float[np.ndarray, " column"],
    least: Float[np.ndarray, " column"],
) -> Float[np.ndarray, " column"]:  # fmt: skip
    """Weights from normal equations, each at or above 0 where ``least`` is 0."""
    free = np.linalg.lstsq(square, product, rcond=1e-9)[0]
    if (free >= least).all():
        return free
    s, V = np.linalg.eigh(square)
    kept = s > 1e-9 * s.max()
    root = np.sqrt(s[kept])
    return lsq_linear(root[:, None] * V[:, kept].T, V[:, kept].T @ product / root, (least, np.inf), method="bvls").x


def _scale(X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, " column"]:
    """Root mean square of every column; 1 for a column of zeros."""
    size = np.sqrt((X**2).mean(axis=0))
    return np.where(size > 0, size, 1.0)
