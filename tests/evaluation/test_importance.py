"""Importance of groups for a classifier whose rule is known."""

import numpy as np
import pytest

from learn.evaluation.importance import grouped_permutation
from swgsim.common.seeds import generator


class Rule:
    """Cracked where column 0 or its copy in column 1 is high, else worn where column 2 lies above its speed's level."""

    def predict(self, X):
        cracked = X[:, 0] + X[:, 1] > 1
        return np.where(cracked, "cracked", np.where(X[:, 2] > X[:, 4], "worn", "healthy"))


GROUPS = {"pair": [0, 1], "first": [0], "wear": [2], "noise": [3], "speed": [4]}


def rows(count=1500):
    """Features, classes and operating points; column 4 is the level of the operating point."""
    rng = generator("rule")
    label, block = rng.integers(3, size=count), rng.integers(2, size=count)
    cracked, level = (label == 2).astype(float), 100.0 * block
    X = np.c_[cracked, cracked, level + np.where(label == 1, 1.0, -1.0), rng.normal(size=count), level]
    return X, np.array(["healthy", "worn", "cracked"])[label], block


def importance(groups=GROUPS, repeats=5):
    X, y, block = rows()
    table = grouped_permutation(Rule(), X, y, groups, block, generator("permute"), repeats=repeats)
    return table.set_index(["group", "label"])


def test_each_group_carries_what_the_rule_reads_from_it():
    drop = importance()["drop"]
    share = 1 / 3
    assert drop["pair", "cracked"] == pytest.approx(100 * (1 - share), abs=5)
    assert drop["wear", "worn"] == pytest.approx(100 * 2 / 3, abs=5)
    assert drop["wear", "cracked"] == 0
    assert (drop["noise"] == 0).all()


def test_doubt_is_twice_the_standard_error_of_the_repeats():
    few, many = (importance(repeats=repeats)["doubt"]["pair", "cracked"] for repeats in (10, 160))
    expected = (
        2 * 100 * np.sqrt(2 / 9 / 500 / 160)
    )  # of a share among 500 cracked rows, a little less without replacing
    assert expected / 2 < many < 1.2 * expected
    assert many < few / 2
    assert importance()["doubt"]["noise", "cracked"] == 0


def test_values_stay_at_their_operating_point():
    X, y, block = rows()
    assert (importance()["drop"]["speed"] == 0).all()
    across = grouped_permutation(Rule(), X, y, GROUPS, np.zeros_like(block), generator("permute"))
    assert across.set_index(["group", "label"])["drop"]["speed", "worn"] > 10


def test_columns_of_a_group_move_together_and_the_features_stay():
    seen = []

    class Watch(Rule):
        def predict(self, X):
            seen.append((X[:, 0] == X[:, 1]).all())
            return super().predict(X)

    X, y, block = rows()
    before = X.copy()
    grouped_permutation(Watch(), X, y, {"pair": [0, 1]}, block, generator("permute"), repeats=3)
    assert seen == [True, True]  # unchanged, and all three copies at once
    np.testing.assert_array_equal(X, before)


def test_unknown_column_is_refused():
    with pytest.raises(ValueError, match="group 'pair': column 5, the features have 0 to 4"):
        importance({"pair": [0, 5]})
