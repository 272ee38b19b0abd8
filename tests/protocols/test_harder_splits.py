"""Left-out fault sizes and operating points are never in training, and no specimen is on both sides."""

import re

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learn.evaluation.evaluate import metric_key
from learn.protocols.fault_size import size
from learn.protocols.harder_splits import LeaveOperatingPointOut, LeaveSeverityOut
from swgsim.storage.labelled_signals import CLASSES

FAULTS = CLASSES[1:]
few = settings(deadline=None, max_examples=25)


def table_of(gears=2, labels=CLASSES, variants=6, levels=6, speeds=(2000.0, 4000.0), loads=(7.0,)):
    """A grid in which each class has `levels` severities, between 0 and 1, that the variants take in turn."""
    rows = [
        (g, c, v, np.nan if c == "healthy" else (1 + v % levels) / (1 + levels), n, load)
        for g in range(1, gears + 1) for c in labels for v in range(variants) for n in speeds for load in loads
    ]  # fmt: skip
    table = pd.DataFrame(rows, columns=["gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm"])
    return table.assign(label=pd.Categorical(table["label"], categories=CLASSES))


def splits_of(protocol, table):
    return list(protocol.split(np.zeros((len(table), 1)), table))


def specimens(table, rows):
    return set(zip(*(table[name].to_numpy()[rows] for name in ("gear", "label", "variant")), strict=True))


def points(table, rows):
    return set(zip(*(table[name].to_numpy()[rows] for name in ("n_in_rpm", "T_out_nm")), strict=True))


def sizes(table, rows, label):
    of_class = table.iloc[rows][table["label"].iloc[rows] == label]
    return size(label, of_class["severity"].to_numpy())


@st.composite
def grids(draw):
    """A shuffled table with two classes or more, and a number of parts or folds that it is large enough for."""
    number = draw(st.integers(2, 4))
    levels = draw(st.integers(number, 7))
    labels = draw(st.lists(st.sampled_from(FAULTS), min_size=1, max_size=3, unique=True))
    loads = draw(st.lists(st.floats(0.1, 100), min_size=1, max_size=3, unique=True))
    table = table_of(
        draw(st.integers(1, 3)), ("healthy", *labels), draw(st.integers(levels, 12)), levels, loads=tuple(loads)
    )
    order = np.random.default_rng(draw(st.integers(0, 100))).permutation(len(table))
    return number, table.iloc[order].reset_index(drop=True)


@few
@given(grids())
def test_parts_of_ascending_fault_size_test_every_row_once_and_train_on_no_tested_size_or_specimen(grid):
    parts, table = grid
    splits = splits_of(LeaveSeverityOut(parts), table)
    below = dict.fromkeys(set(table["label"]) - {"healthy"}, 0.0)
    assert len({split.name for split in splits}) == len(splits) == parts
    assert np.array_equal(np.sort(np.concatenate([split.test for split in splits])), np.arange(len(table)))
    for split in splits:
        assert np.array_equal(np.sort(np.concatenate(split[1:])), np.arange(len(table)))
        assert specimens(table, split.train).isdisjoint(specimens(table, split.test))
        for rows in (split.train, split.test):
            assert set(table["label"].iloc[rows]) == set(table["label"])
        for label in below:
            tested, trained = sizes(table, split.test, label), sizes(table, split.train, label)
            assert below[label] < tested.min()
            assert not ((tested.min() <= trained) & (trained <= tested.max())).any()
            below[label] = tested.max()


@few
@given(st.integers(2, 5), st.integers(5, 20), st.integers(1, 3))
def test_parts_of_different_severities_are_equal_in_number(parts, variants, gears):
    table = table_of(gears, variants=variants, levels=variants, speeds=(2000.0,))
    counts = [table["label"].iloc[split.test].value_counts() for split in splits_of(LeaveSeverityOut(parts), table)]
    for label in CLASSES:
        of_parts = [count[label] for count in counts]
        assert max(of_parts) - min(of_parts) <= gears  # gears share severities, of which one more may be in a part


def severities_of_parts(parts, *severities):
    """The severities of a class that each part tests."""
    table = table_of(1, ("tip_tooth_crack",), len(severities), speeds=(2000.0,)).assign(severity=severities)
    return [table["severity"].iloc[split.test].tolist() for split in splits_of(LeaveSeverityOut(parts), table)]


def test_equal_severities_are_not_cut_apart_and_cuts_are_nearest_to_equal_shares():
    assert severities_of_parts(3, 0.1, 0.1, 0.1, 0.1, 0.2, 0.3) == [[0.1] * 4, [0.2], [0.3]]
    assert severities_of_parts(3, 0.1, 0.2, 0.3, 0.3, 0.3, 0.3) == [[0.1], [0.2], [0.3] * 4]
    assert severities_of_parts(2, 0.1, 0.2, 0.2, 0.2, 0.3, 0.4) == [[0.1, 0.2, 0.2, 0.2], [0.3, 0.4]]
    assert severities_of_parts(2, 0.1, 0.2, 0.3, 0.3, 0.3, 0.4) == [[0.1, 0.2], [0.3, 0.3, 0.3, 0.4]]


def test_the_mild_cracks_of_the_papers_grid_are_those_with_most_remaining_stiffness():
    table = table_of(1, ("root_tooth_crack",), 60, speeds=(2000.0,)).assign(severity=np.repeat([0.10, 0.03, 0.01], 20))
    tested = {split.name: table["severity"].iloc[split.test].tolist() for split in splits_of(LeaveSeverityOut(), table)}
    assert tested == {"mild": [0.10] * 20, "medium": [0.03] * 20, "severe": [0.01] * 20}


@few
@given(grids(), st.integers(0, 100))
def test_a_left_out_point_and_its_specimens_are_not_trained_on_whatever_the_order_of_rows(grid, seed):
    folds, table = grid
    splits = splits_of(LeaveOperatingPointOut(folds), table)
    tested = [points(table, split.test) for split in splits]
    assert all(len(found) == 1 for found in tested)
    assert sorted(set.union(*tested)) == sorted(points(table, range(len(table))))
    assert len(splits) == len(set.union(*tested))
    for split, found in zip(splits, tested, strict=True):
        assert points(table, split.train) == set.union(*tested) - found
        assert specimens(table, split.train).isdisjoint(specimens(table, split.test))
        assert specimens(table, split.train) | specimens(table, split.test) == specimens(table, range(len(table)))
        for rows in (split.train, split.test):
            assert set(table["label"].iloc[rows]) == set(table["label"])
    shuffled = table.iloc[np.random.default_rng(seed).permutation(len(table))].reset_index(drop=True)
    for protocol in (LeaveSeverityOut(folds), LeaveOperatingPointOut(folds)):
        for one, other in zip(splits_of(protocol, table), splits_of(protocol, shuffled), strict=True):
            assert one.name == other.name
            assert specimens(table, one.test) == specimens(shuffled, other.test)


def test_points_test_a_quarter_of_the_specimens_of_each_gear_and_class_and_take_them_in_turn():
    table = table_of(variants=8, loads=(7.0, 39.0))
    tested = [specimens(table, split.test) for split in splits_of(LeaveOperatingPointOut(), table)]
    for found in tested:
        counts = pd.DataFrame(found).groupby([0, 1]).size()
        assert (counts == 2).all()
        assert len(counts) == 2 * len(CLASSES)
    assert sum(map(len, tested)) == len(set.union(*tested)) == 2 * len(CLASSES) * 8


def test_names_of_splits_are_valid_in_metrics():
    table = table_of(speeds=(2000.0, 1.5e7), loads=(7.0, 0.1))
    named = {
        LeaveSeverityOut(): ["mild", "medium", "severe"],
        LeaveSeverityOut(2): ["part 1 of 2", "part 2 of 2"],
        LeaveOperatingPointOut(): [
            "2000 rpm, 0.1 N m", "2000 rpm, 7 N m", "15000000 rpm, 0.1 N m", "15000000 rpm, 7 N m",
        ],
    }  # fmt: skip
    for protocol, names in named.items():
        found = [split.name for split in splits_of(protocol, table)]
        assert found == names
        assert all(re.fullmatch(r"[\w\-. :/]+", f"test/{metric_key(name)}", re.ASCII) for name in found)


@pytest.mark.parametrize("protocol", [LeaveSeverityOut, LeaveOperatingPointOut])
def test_same_seed_same_specimens_and_another_seed_others(protocol):
    table = table_of()
    first, again, other = (splits_of(protocol(seed=seed), table)[0] for seed in (0, 0, 1))
    assert np.array_equal(first.test, again.test)
    assert np.array_equal(first.train, again.train)
    assert not np.array_equal(first.test, other.test)


@pytest.mark.parametrize(
    ("protocol", "table", "message"),
    [
        (
            LeaveSeverityOut(3),
            table_of(labels=FAULTS[-1:], levels=2),
            "class tip_tooth_crack has 2 severities, fewer than 3 parts: take fewer parts or more severities",
        ),
        (
            LeaveSeverityOut(3),
            table_of(labels=CLASSES[:1], variants=2),
            "gear 1 has 2 variants of healthy, fewer than 3 parts: take fewer parts or more variants",
        ),
        (
            LeaveOperatingPointOut(4),
            table_of(variants=3),
            "gear 1 has 3 variants of healthy, fewer than 4 folds: take fewer folds or more variants",
        ),
        (
            LeaveOperatingPointOut(),
            table_of(speeds=(2000.0,)),
            "1 operating point found, leaving one out needs at least 2: take a grid with more",
        ),
    ],
)
def test_a_grid_too_small_for_its_protocol_is_refused(protocol, table, message):
    with pytest.raises(ValueError, match=message):
        splits_of(protocol, table)
    with pytest.raises(ValueError, match="of the protocol is 1, must be an integer from 2"):
        type(protocol)(1)
