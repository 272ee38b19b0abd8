"""Zeros of the torque flanges, from healthy recordings of the session in question.

The flanges have a bias over a session, and the reference of a gear is another session than its samples. The logarithm
of the efficiency relative to the reference then errs, to first order, by

    d_out / T_out - d_in / T_in,    T_in = T_out / (eta (N + 1)),

with the change d_out, d_in of both biases since the reference [N m]. Two numbers thus describe all operating points of
a session. A few healthy recordings of it show them, for source and target gears alike; no fault is recorded.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from learn.inputs.auxiliary_inputs import LOG, changes_of_efficiency
from learn.inputs.inputs import OPERATING_POINT, SPECIMEN, LearningSet
from learn.inputs.joint_rows import joint_rows
from learn.protocols.levels import Episode, Target


@dataclass(frozen=True)
class Rezero:
    """Correction of the efficiency of every gear by K of its own healthy recordings at each operating point.

    The prior of the biases, the slope of the efficiency over the measured temperature and the scatter of healthy
    recordings come from the healthy recordings of the source gears. Without a recording (K = 0) the biases have their
    mean over the source gears.
    """

    def rezeroed(
        self, data: LearningSet, episode: Episode, number: int, draw: int
    ) -> tuple[LearningSet, Int[np.ndarray, " row"]]:
        """The inputs with corrected efficiencies, and the rows to train on.

        Source gears are trained without the recordings that corrected them, so that they are like the target gears.

        Parameters
        ----------
        data : LearningSet
        episode : Episode
        number : int
            Number K of healthy specimens of each gear; those of a target gear come from its labelled pool.
        draw : int

        Raises
        ------
        ValueError
            If the inputs lack the efficiency relative to the reference, or specimens were recorded on several days.
        """
        if data.recordings is not None:
            count = data.layout.points
            of_recordings = episode.of_recordings(count)
            corrected, rows = self.rezeroed(data.recordings, of_recordings, number, draw)
            return joint_rows(corrected), rows[::count] // count
        if LOG not in data.names:
            raise ValueError(
                f"rezero corrects the efficiency, and {LOG!r} is not among the inputs: take features=harmonics, "
                "lines or residual, with features.efficiency=true"
            )
        if data.table.duplicated([*SPECIMEN, *OPERATING_POINT]).any():
            raise ValueError(
                "specimens were recorded several times at an operating point, and rezero finds the biases of one "
                "session: take a grid with days=1"
            )
        gear, healthy = data.table["gear"].to_numpy(), (data.table["label"] == "healthy").to_numpy()
        nothing = episode.source[:0]
        sources = [
            Target(int(each), episode.source[gear[episode.source] == each], nothing, nothing)
            for each in np.unique(gear[episode.source])
        ]
        model = HealthyEfficiency.of(data, episode.source[healthy[episode.source]])
        change, used = model.change.copy(), np.zeros(len(gear), bool)
        for each in (*sources, *episode.targets):
            shots = each.shots(data.table, number, draw)
            shots = shots[healthy[shots]]
            of_gear = gear == each.gear
            change[of_gear] -= model.directions[of_gear] @ model.biases(shots)
            used[shots] = True
        return _with_change(data, model.change, change), episode.source[~used[episode.source]]


@dataclass(frozen=True)
class HealthyEfficiency:
    """How the logarithm of the relative efficiency of healthy recordings varies.

    Attributes
    ----------
    change : array (row,)
        Logarithm of the efficiency relative to the reference, of all recordings [-].
    warm : array (row,)
        The part of it that the temperature explains [-].
    directions : array (row, 2)
        Change by a bias of the flange at the output, and by one at the input times -(N + 1) [1/(N m)].
    variance : array (row,)
        Of healthy recordings about their gear's mean at the operating point [-].
    mean, covariance : array (2,), array (2, 2)
        Of the biases over the source gears [N m, N^2 m^2].
    """

    change: Float[np.ndarray, " row"]
    warm: Float[np.ndarray, " row"]
    directions: Float[np.ndarray, "row 2"]
    variance: Float[np.ndarray, " row"]
    mean: Float[np.ndarray, " 2"]
    covariance: Float[np.ndarray, "2 2"]

    @classmethod
    def of(cls, data: LearningSet, healthy: Int[np.ndarray, " row"]) -> "HealthyEfficiency":
        """From the numbers of healthy rows of the source gears."""
        table, change = data.table, np.asarray(data.features)[:, data.names.index(LOG)]
        point = table.groupby(list(OPERATING_POINT)).ngroup().to_numpy()
        cell = table.groupby(["gear", *OPERATING_POINT]).ngroup().to_numpy()[healthy]
        temperature = table["temperature_c"].to_numpy()
        temperature = np.nan_to_num(temperature - temperature[healthy].mean())
        warm, variance = np.zeros(len(change)), np.zeros(len(change))
        within, warmer = (values[healthy] - _means(values[healthy], cell) for values in (change, temperature))
        for each in np.unique(point):
            here, every = point[healthy] == each, point == each
            slope = within[here] @ warmer[here] / max(warmer[here] @ warmer[here], np.finfo(float).tiny)
            warm[every] = slope * temperature[every]
            left = within[here] - slope * warmer[here]
            # At least rounding, as recordings of a simulation without noise are equal.
            spread = left @ left / max(here.sum() - len(np.unique(cell[here])) - 1, 1)
            variance[every] = max(spread, np.finfo(float).eps)
        load, eta = table["T_out_nm"].to_numpy(), table["efficiency"].to_numpy()
        directions = np.column_stack([1 / load, eta / np.exp(change) / load])
        gears = table["gear"].to_numpy()[healthy]
        if len(np.unique(gears)) < 2:
            raise ValueError(
                f"rezero learns how far the zeros of sessions lie apart, and {len(np.unique(gears))} source gears have "
                "healthy recordings: take at least 2"
            )
        unknown = cls(change, warm, directions, variance, np.zeros(2), np.eye(2))
        each_gear = np.array([unknown.least_squares(healthy[gears == gear]) for gear in np.unique(gears)])
        return replace(unknown, mean=each_gear.mean(axis=0), covariance=np.atleast_2d(np.cov(each_gear.T)))

    def least_squares(self, rows: Int[np.ndarray, " row"]) -> Float[np.ndarray, " 2"]:
        """The biases that fit healthy rows of a gear best, without a prior."""
        weight = 1 / np.sqrt(self.variance[rows])
        found, *_ = np.linalg.lstsq(
            self.directions[rows] * weight[:, None], (self.change - self.warm)[rows] * weight, rcond=None
        )
        return np.asarray(found)

    def biases(self, rows: Int[np.ndarray, " row"]) -> Float[np.ndarray, " 2"]:
        """The biases of the session of healthy rows of a gear, the mean of their posterior."""
        left = (self.change - self.warm)[rows] - self.directions[rows] @ self.mean
        across = self.directions[rows] @ self.covariance
        gain = np.linalg.solve(across @ self.directions[rows].T + np.diag(self.variance[rows]), across)
        return self.mean + left @ gain


def _means(values: Float[np.ndarray, " row"], cell: Int[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """Mean of the cell of each row."""
    _, number = np.unique(cell, return_inverse=True)
    return (np.bincount(number, values) / np.bincount(number))[number]


def _with_change(data: LearningSet, before: Float[np.ndarray, " row"], after: Float[np.ndarray, " row"]) -> LearningSet:
    """The inputs with another change of the efficiency."""
    table = data.table
    eta = table["efficiency"].to_numpy()
    columns = changes_of_efficiency(
        eta * np.exp(after - before), eta / np.exp(before), table["n_in_rpm"].to_numpy(), table["T_out_nm"].to_numpy()
    )
    features = np.array(data.features)
    for name, values in columns.items():
        features[:, data.names.index(name)] = values
    return replace(data, features=features)
