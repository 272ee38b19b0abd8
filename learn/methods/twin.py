"""A classifier that is trained on nothing: the twin of the gear whose references a row has."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.rows import Inputs
from learn.methods.contract import believed_classes

if TYPE_CHECKING:
    from swgsim.gear.gear import OperatingPoint
    from swgsim.oracle.cells import Partition
    from swgsim.oracle.point import PointModel
    from swgsim.twin import Knowledge, Twin

# Columns of a row before those of its references: operating point and observation.
POINT = 2
# Twins in memory, 30 MB each.
CACHED_TWINS = 8


class TwinClassifier:
    """Bayes' rule on the simulation chain, fitted to the references of the judged gear.

    It takes rows of ``features=referenced``. ``fit`` learns nothing but the names of the classes: each row is judged by
    itself, from its observation and the references of its gear.

    Parameters
    ----------
    gear, grid, condition, window, mesh : mapping
        What is believed, as ``conf/generate.yaml`` has it: the nominal gear; severities and scatter; the bench;
        sampling; the mesh. Operating points are those of the references.
    resolution : mapping
        Options of :class:`swgsim.oracle.cells.Resolution`.
    further : sequence of str
        As of :class:`swgsim.twin.Knowledge`.
    """

    def __init__(
        self,
        gear: Mapping[str, Any],
        grid: Mapping[str, Any],
        condition: Mapping[str, Any],
        window: Mapping[str, Any],
        mesh: Mapping[str, Any],
        resolution: Mapping[str, Any],
        further: Sequence[str],
    ):
        self.classes = tuple(grid["classes"])
        believed = {
            "gears": {"nominal": gear}, "grid": {**grid, "population": None}, "condition": condition, "window": window,
            "mesh": mesh, "resolution": resolution, "further": list(further),
        }  # fmt: skip
        self._believed = json.dumps(believed, sort_keys=True)

    def fit(self, X: Inputs, y: np.ndarray) -> "TwinClassifier":
        """Note the names of the classes.

        Raises
        ------
        ValueError
            If a class is not among those that are believed.
        """
        self.classes_ = believed_classes(y, self.classes)
        return self

    def predict(self, X: Inputs) -> np.ndarray:
        """Likeliest class of each row."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def predict_proba(self, X: Inputs) -> Float[np.ndarray, "row class"]:
        """Probability of each class, all of them equally frequent; raises like :meth:`diagnosis`."""
        from swgsim.storage.labelled_signals import CLASSES

        found = np.empty((len(X), len(self.classes_)))
        columns = [CLASSES.index(name) for name in self.classes_]
        for rows, model, _, x in self._at_points(X):
            p = np.exp(model.log_posterior(x))[:, columns]
            found[rows] = p / p.sum(axis=1, keepdims=True)
        return found

    def diagnosis(self, X: Inputs) -> pd.DataFrame:
        """Probability of every class, and severity and position with intervals (:mod:`swgsim.oracle.diagnosis`).

        Raises
        ------
        ValueError
            If the rows are no rows of ``features=referenced``.
        """
        from swgsim.oracle.diagnosis import diagnosis

        parts = [diagnosis(model, cells, x).set_index(rows) for rows, model, cells, x in self._at_points(X)]
        return pd.concat(parts).sort_index()

    def _at_points(
        self, X: Inputs
    ) -> Iterator[tuple[np.ndarray, "PointModel", Mapping[str, "Partition"], Float[np.ndarray, "sample feature"]]]:
        """Rows of every gear at every operating point, with its densities, the cells of classes, and observations."""
        from swgsim.gear.gear import OperatingPoint
        from swgsim.oracle.model import partitions_of
        from swgsim.oracle.oracle import FEATURES

        rows = np.asarray(X)
        before = POINT + FEATURES
        if rows.shape[1] <= before or (rows.shape[1] - before) % (before + 1):
            raise ValueError(f"{rows.shape[1]} columns are no rows with references: choose features=referenced")
        gears, of_gear = np.unique(rows[:, before:], axis=0, return_inverse=True)
        for number, said in enumerate(gears):
            twin = _twin(self._believed, said.tobytes())
            partitions = partitions_of(twin.knowledge.plan, twin.knowledge.resolution)
            here = np.flatnonzero(of_gear.ravel() == number)
            for speed, load in np.unique(rows[here, :POINT], axis=0).tolist():
                chosen = here[(rows[here, 0] == speed) & (rows[here, 1] == load)]
                model = twin.densities([OperatingPoint(speed, load)])
                yield chosen, model, partitions, rows[chosen, POINT:before]


@lru_cache(maxsize=CACHED_TWINS)
def _twin(believed: str, said: bytes) -> "Twin":
    """The twin of the gear whose references are given as they stand in a row, in double precision."""
    from swgsim.gear.gear import OperatingPoint
    from swgsim.oracle.oracle import FEATURES
    from swgsim.twin import References, Twin, fit_gear

    columns = np.frombuffer(said).reshape(-1, POINT + 1 + FEATURES)
    points = tuple(OperatingPoint(*point) for point in columns[:, :POINT].tolist())
    references = References(points, columns[:, POINT + 1 :], columns[:, POINT])
    knowledge = _knowledge(believed, points)
    return Twin.of(knowledge, fit_gear(knowledge, references))


@lru_cache(maxsize=1)
def _knowledge(believed: str, points: tuple["OperatingPoint", ...]) -> "Knowledge":
    """What is believed of gears, bench and faults, at some operating points."""
    from swgsim.jobs import settings
    from swgsim.oracle.cells import Resolution
    from swgsim.twin import Knowledge

    choices = json.loads(believed)
    plan = settings.plan(choices)
    resolution = settings.build(Resolution, choices["resolution"])
    return Knowledge(replace(plan, grid=replace(plan.grid, points=points)), resolution, tuple(choices["further"]))
