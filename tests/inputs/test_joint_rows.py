"""Rows of units have every feature at every recording of a specimen, whatever the order of the recordings."""

from dataclasses import replace

import numpy as np
import pytest
from fabricated import recordings

from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import SPECIMEN, LearningSet
from learn.inputs.joint_rows import joint_rows
from learn.inputs.signals import Signals

DATA = Harmonics("harmonics", 6).learning_set([recordings(gears=2, variants=3, disturbance=1e-3)])
POINTS = 4


def shuffled(data: LearningSet, rows: np.ndarray) -> LearningSet:
    return replace(data, features=data.features[rows], table=data.table.iloc[rows].reset_index(drop=True))


def test_a_row_has_every_feature_at_each_operating_point():
    units = joint_rows(DATA)
    assert units.features.shape == (len(DATA.table) // POINTS, POINTS * len(DATA.names))
    assert units.layout == (len(DATA.names), POINTS, False)
    of_first = (DATA.table[list(SPECIMEN)] == units.table.loc[0, list(SPECIMEN)]).all(axis=1)
    at_points = DATA.table[of_first].sort_values(["n_in_rpm", "T_out_nm"]).index
    np.testing.assert_array_equal(units.features[0].reshape(-1, POINTS), DATA.features[at_points].T)
    assert units.names[:2] == (f"{DATA.names[0]} of recording 1", f"{DATA.names[0]} of recording 2")
    assert units.table[["n_in_rpm", "T_out_nm"]].isna().all(axis=None)


def test_the_order_of_the_recordings_has_no_say():
    units = joint_rows(DATA)
    others = joint_rows(shuffled(DATA, np.random.default_rng(0).permutation(len(DATA.table))))
    keys = list(SPECIMEN)
    here, there = (each.table[keys].sort_values(keys).index for each in (units, others))
    np.testing.assert_array_equal(units.features[here], others.features[there])
    np.testing.assert_array_equal(units.recordings.features[:POINTS].T.ravel(), units.features[0])


def test_specimens_at_other_operating_points_and_signals_are_refused():
    with pytest.raises(ValueError, match="3 to 4 recordings, not all of them at the same operating points"):
        joint_rows(shuffled(DATA, np.arange(1, len(DATA.table))))
    signals = Signals("residual", 16, 6).learning_set([recordings(gears=1)])
    with pytest.raises(ValueError, match="signals over the angle: take features=harmonics"):
        joint_rows(signals)
