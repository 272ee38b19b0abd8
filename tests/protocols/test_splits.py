"""Splits are disjoint and cover the data; a grouped split has no variant and no copy of a row on both sides."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learn.protocols.splits import GroupedFolds, LeaveOneGearOut, RandomFolds, independent_groups
from swgsim.storage.labelled_signals import CLASSES


@st.composite
def grids(draw):
    """Facts and features of a grid in which some classes have copies of rows, within a variant or all over."""
    gears, variants, points = draw(st.integers(2, 7)), draw(st.integers(4, 6)), draw(st.integers(1, 3))
    labels = draw(st.lists(st.sampled_from(CLASSES), min_size=2, max_size=4, unique=True))
    rows = [(g, c, v, p) for g in range(1, gears + 1) for c in labels for v in range(variants) for p in range(points)]
    table = pd.DataFrame(rows, columns=["gear", "label", "variant", "point"])
    copies = {label: draw(st.sampled_from(["none", "over variants", "everywhere"])) for label in labels[1:]}
    features = np.random.default_rng(0).standard_normal((len(rows), 3))
    for label, kind in copies.items():
        of_class = (table["label"] == label).to_numpy()
        if kind == "everywhere":
            features[of_class] = -1.0
        elif kind == "over variants":
            features[of_class] = table.loc[of_class, ["gear", "point", "gear"]]
    return features, table


@settings(deadline=None, max_examples=50)
@given(grids(), st.integers(2, 5))
def test_random_folds_and_gears_left_out_test_every_row_once(grid, folds):
    features, table = grid
    for protocol, number in ((RandomFolds(), 4), (LeaveOneGearOut(folds), min(folds, table["gear"].nunique()))):
        splits = list(protocol.split(features, table))
        assert len(splits) == number
        assert np.array_equal(np.sort(np.concatenate([split.test for split in splits])), np.arange(len(table)))
        for split in splits:
            assert np.array_equal(np.sort(np.concatenate(split[1:])), np.arange(len(table)))
            if isinstance(protocol, LeaveOneGearOut):
                assert not set(table["gear"].iloc[split.train]) & set(table["gear"].iloc[split.test])


@settings(deadline=None, max_examples=50)
@given(grids())
def test_grouped_folds_keep_variants_and_identical_rows_together_and_test_all_but_connected_classes(grid):
    features, table = grid
    splits = list(GroupedFolds().split(features, table))
    for split in splits:
        assert np.array_equal(np.sort(np.concatenate(split[1:])), np.arange(len(table)))
        assert len(split.test) > 0
        for identity in (table[["gear", "label", "variant"]].to_numpy(), features):
            assert not set(map(tuple, identity[split.train])) & set(map(tuple, identity[split.test]))
    tested = np.concatenate([s.test for s in splits])
    assert len(set(tested)) == len(tested)
    identical = {
        label for label in set(table["label"]) if len(np.unique(features[table["label"] == label], axis=0)) == 1
    }
    assert set(table["label"]) - set(table["label"].iloc[tested]) == identical
    assert len(tested) == (~table["label"].isin(identical)).sum()


def table_of(gears, variants=4):
    rows = [(g, c, v) for g in range(1, gears + 1) for c in ("healthy", "root_tooth_crack") for v in range(variants)]
    return pd.DataFrame(rows, columns=["gear", "label", "variant"])


def test_gears_are_left_out_in_the_papers_order():
    table = table_of(3)
    names = [s.name for s in LeaveOneGearOut().split(np.zeros((len(table), 1)), table)]
    assert names == ["1,2->3", "2,3->1", "1,3->2"]


def test_rows_that_differ_by_rounding_are_one_group():
    table = table_of(1, variants=2)
    features = np.array([[1.0], [1.0 + 1e-15], [3.0], [4.0]])
    group = independent_groups(features, table)
    assert group[0] == group[1]
    assert len(set(group)) == 3


def test_same_seed_same_folds_and_another_seed_others():
    table = table_of(3, variants=8)
    features = np.random.default_rng(0).standard_normal((len(table), 2))
    for protocol in (RandomFolds, GroupedFolds):
        first, again, other = (next(iter(protocol(seed=s).split(features, table))).test for s in (0, 0, 1))
        assert np.array_equal(first, again)
        assert not np.array_equal(first, other)


@pytest.mark.parametrize("protocol", [RandomFolds, GroupedFolds, LeaveOneGearOut])
def test_a_single_fold_is_refused(protocol):
    with pytest.raises(ValueError, match="folds of the protocol is 1, must be an integer from 2"):
        protocol(folds=1)


@pytest.mark.parametrize(
    ("protocol", "gears", "message"),
    [
        (RandomFolds(9), 2, "class healthy has 8 rows, fewer than 9 folds: take fewer folds"),
        (GroupedFolds(9), 1, "8 independent groups of variants are fewer than 9 folds"),
        (LeaveOneGearOut(), 1, "1 gear found, leaving one out needs at least 2"),
    ],
)
def test_a_grid_too_small_for_its_protocol_is_refused(protocol, gears, message):
    table = table_of(gears)
    features = np.random.default_rng(0).standard_normal((len(table), 2))
    with pytest.raises(ValueError, match=message):
        list(protocol.split(features, table))
