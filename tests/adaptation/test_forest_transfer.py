"""Adapted forests agree with calculation by hand on a tree of two levels."""

import numpy as np
import pytest
from sklearn.ensemble import ExtraTreesClassifier, RandomForestClassifier
from sklearn.linear_model import LogisticRegression

from learn.adaptation.forest_transfer import (
    AddedTrees,
    LeafRelabelling,
    StructureTransfer,
    choose_threshold,
    jensen_shannon,
)
from learn.adaptation.transfer import Labelled
from learn.methods.flat_forest import flatten

NONE = Labelled(np.empty((0, 2)), np.empty(0, dtype=str))
CORNERS = Labelled(np.array([[0.0, 0], [0, 1], [1, 0], [1, 1]]), np.array(["a", "a", "b", "c"]))


@pytest.fixture(scope="module")
def tree():
    """Column 0 parts a from the others at 0.5, then column 1 parts b from c at 0.5."""
    return RandomForestClassifier(1, bootstrap=False, max_features=None, random_state=0).fit(*CORNERS)


def clouds(shift=0.0, rows=240, seed=0):
    """Three classes in six columns, all of them moved."""
    rng = np.random.default_rng(seed)
    y = np.resize(["a", "b", "c"], rows)
    centres = 2 * np.eye(3, 6)[np.searchsorted(["a", "b", "c"], y)]
    return Labelled(rng.standard_normal((rows, 6)) + centres + shift, y)


def adapted(method, source, shots):
    return method.adapt(source, NONE, shots, np.empty((0, shots.X.shape[1])), 0)


@pytest.mark.parametrize("kind", [RandomForestClassifier, ExtraTreesClassifier])
def test_the_flat_forest_is_the_forest(kind):
    forest, query = kind(20, random_state=0).fit(*clouds()), clouds(seed=1).X
    flat = flatten(forest)
    np.testing.assert_allclose(flat.predict_proba(query), forest.predict_proba(query), atol=1e-14)
    assert np.array_equal(flat.predict(query), forest.predict(query))


def test_leaves_are_relabelled_as_computed_by_hand(tree):
    shots = Labelled(np.array([[0.0, 0], [0, 0], [0, 1], [0, 1], [1, 1]]), np.array(["a", "b", "b", "b", "c"]))
    result = adapted(LeafRelabelling(strength=2), tree, shots).predict_proba(CORNERS.X)
    in_a = [(2 + 1) / 6, 3 / 6, 0]  # 2 pseudo counts of a, and 4 shots
    assert result.tolist() == [in_a, in_a, [0, 1, 0], [0, 0, 1]]


def test_an_infinite_strength_is_the_source_and_none_is_the_shots():
    source, shots = RandomForestClassifier(10, max_depth=3, random_state=0).fit(*clouds()), clouds(2.0, seed=1)
    strong = adapted(LeafRelabelling(strength=1e12), source, shots)
    np.testing.assert_allclose(strong.predict_proba(shots.X), source.predict_proba(shots.X), atol=1e-9)
    weak = adapted(LeafRelabelling(strength=1e-12), source, shots)
    leaves, numbers = weak.leaves(shots.X), np.searchsorted(weak.classes_, shots.y)
    leaf = leaves[0, 0]
    frequencies = np.bincount(numbers[leaves[:, 0] == leaf], minlength=3) / np.sum(leaves[:, 0] == leaf)
    np.testing.assert_allclose(weak.probabilities[leaf], frequencies, atol=1e-9)


def test_thresholds_follow_the_target_and_sides_are_exchanged(tree):
    shots = Labelled(np.array([[10.0, 0], [10, 5], [11, 21], [11, 20]]), np.array(["a", "a", "b", "c"]))
    forest = adapted(StructureTransfer(), tree, shots)
    root = forest.roots[0]
    b_or_c = forest.right[root]
    assert (forest.feature[root], forest.threshold[root]) == (0, 10.5)
    assert (forest.feature[b_or_c], forest.threshold[b_or_c]) == (1, 20.5)
    assert forest.predict(np.array([[10.4, 30], [10.6, 20.4], [10.6, 20.6]])).tolist() == ["a", "c", "b"]
    source = flatten(tree)
    assert forest.left[b_or_c] == source.right[b_or_c]  # c lay above b, now it lies below


def test_a_node_whose_shots_cannot_be_parted_becomes_a_leaf(tree):
    shots = Labelled(np.array([[0.0, 0], [1, 3], [1, 3], [1, 3]]), np.array(["a", "b", "c", "c"]))
    forest = adapted(StructureTransfer(), tree, shots)
    assert forest.predict_proba(np.array([[1.0, 0], [1, 9]])) == pytest.approx(np.array([[0, 1 / 3, 2 / 3]] * 2))


def test_among_the_peaks_of_information_gain_the_divergence_decides():
    # Rows a bbb aa: the gain peaks at 1.5 and, higher, at 4.5; the source's sides are those about 1.5.
    x, one_hot = np.arange(1.0, 7), np.eye(2)[[0, 1, 1, 1, 0, 0]]
    assert choose_threshold(x, one_hot, np.array([[1.0, 0.0], [0.4, 0.6]])) == (1.5, False)
    assert choose_threshold(x, one_hot, np.array([[0.4, 0.6], [1.0, 0.0]])) == (1.5, True)
    assert choose_threshold(x, one_hot, np.array([[0.25, 0.75], [1.0, 0.0]])) == (4.5, False)
    first, second = np.array([[1.0, 0], [1, 0], [0.3, 0.7]]), np.array([[0.0, 1], [0.5, 0.5], [0.3, 0.7]])
    mixed = -0.75 * np.log2(0.75) - 0.25 * np.log2(0.25)
    assert jensen_shannon(first, second) == pytest.approx([1, mixed - 0.5, 0], abs=1e-12)  # bit


def test_added_trees_vote_with_their_share_and_need_not_know_every_class():
    source = RandomForestClassifier(10, random_state=0).fit(*clouds())
    shots = clouds(1.0, seed=1)
    two = Labelled(shots.X[shots.y != "b"], shots.y[shots.y != "b"])
    old, new = source.predict_proba(shots.X), RandomForestClassifier(5, random_state=0).fit(*two)
    expected = 0.7 * old
    expected[:, [0, 2]] += 0.3 * new.predict_proba(shots.X)
    forest = adapted(AddedTrees(count=5, share=0.3), source, two)
    np.testing.assert_allclose(forest.predict_proba(shots.X), expected, atol=1e-12)


@pytest.mark.parametrize("method", [LeafRelabelling(), StructureTransfer(), AddedTrees()])
def test_shots_of_a_moved_target_help_and_the_source_stays(method):
    source = RandomForestClassifier(30, max_depth=5, random_state=0).fit(*clouds())
    before = [tree.tree_.__getstate__() for tree in source.estimators_]
    shots, target = clouds(1.5, 60, seed=1), clouds(1.5, 600, seed=2)
    rows = shots.X.copy()
    forest = adapted(method, source, shots)
    gain = np.mean(forest.predict(target.X) == target.y) - source.score(*target)
    assert gain > 0.02
    after = [tree.tree_.__getstate__() for tree in source.estimators_]
    assert all(np.array_equal(b[k], a[k]) for b, a in zip(before, after, strict=True) for k in ("nodes", "values"))
    assert np.array_equal(rows, shots.X)


def test_what_cannot_be_adapted_is_named(tree):
    linear = LogisticRegression().fit(*CORNERS)
    with pytest.raises(ValueError, match=r"LogisticRegression is no forest: give a fitted"):
        adapted(StructureTransfer(), linear, CORNERS)
    with pytest.raises(ValueError, match=r"class 'd' of the target gear is unknown .* a, b, c"):
        adapted(LeafRelabelling(), tree, Labelled(CORNERS.X, np.array(["a", "b", "c", "d"])))
    with pytest.raises(ValueError, match=r"StructureTransfer received 0 rows of shots"):
        adapted(StructureTransfer(), tree, NONE)
    with pytest.raises(ValueError, match=r"strength of leaf relabelling is 0"):
        LeafRelabelling(strength=0)
