"""Pools and shots of target gears are disjoint, and the same for all methods."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learn.protocols.levels import NewGears
from swgsim.storage.labelled_signals import CLASSES

FACTS = ["gear", "label", "variant", "point"]
few = settings(deadline=None, max_examples=15)


def table_of(gears=4, labels=CLASSES[:2], variants=6, points=2):
    rows = [(g, c, v, p) for g in range(1, gears + 1) for c in labels for v in range(variants) for p in range(points)]
    table = pd.DataFrame(rows, columns=FACTS)
    return table.assign(label=pd.Categorical(table["label"], categories=CLASSES))


@st.composite
def grids(draw):
    """A table and a protocol that it is large enough for."""
    gears, variants = draw(st.integers(3, 6)), draw(st.integers(4, 7))
    labels = draw(st.lists(st.sampled_from(CLASSES), min_size=1, max_size=3, unique=True))
    labelled = draw(st.integers(0, variants - 1))
    protocol = NewGears(
        folds=draw(st.integers(2, 5)),
        development=draw(st.integers(0, gears - 1)),
        labelled=labelled,
        unlabelled=draw(st.integers(0, variants - 1 - labelled)),
        kept_out=draw(st.integers(0, variants - 1)),
        variants=draw(st.none() | st.integers(1, variants)),
        sources=draw(st.none() | st.integers(1, gears)),
    )
    return table_of(gears, labels, variants, draw(st.integers(1, 2))), protocol


def all_episodes(protocol, table):
    for episode in protocol.episodes(table):
        yield episode
        if protocol.development > 1:
            yield from protocol.development_episodes(table, episode)


def pools(target):
    return target.labelled, target.unlabelled, target.judged


def named(table, rows):
    """Facts of rows, independent of their positions."""
    return set(zip(*(table[name].to_numpy()[rows] for name in FACTS), strict=True))


def specimens(table, rows):
    return {row[:3] for row in named(table, rows)}


@few
@given(grids())
def test_pools_are_disjoint_cover_their_gear_and_hold_whole_variants_and_nothing_of_it_is_in_training(grid):
    table, protocol = grid
    variants = table["variant"].nunique()
    wanted = (protocol.labelled, protocol.unlabelled, variants - protocol.labelled - protocol.unlabelled)
    for episode in all_episodes(protocol, table):
        known = set(table["gear"].iloc[np.append(episode.source, episode.kept_out)])
        assert known.isdisjoint(target.gear for target in episode.targets)
        assert specimens(table, episode.source).isdisjoint(specimens(table, episode.kept_out))
        assert len(episode.source) > 0
        for target in episode.targets:
            together = np.sort(np.concatenate(pools(target)))
            assert np.array_equal(together, np.flatnonzero(table["gear"] == target.gear))
            found = [specimens(table, pool) for pool in pools(target)]
            assert sum(map(len, found)) == len(set.union(*found))
            assert [len(pool) for pool in found] == [number * table["label"].nunique() for number in wanted]


@few
@given(grids())
def test_every_gear_is_left_out_once_and_development_gears_only_for_the_choice_of_options(grid):
    table, protocol = grid
    gears = np.unique(table["gear"])
    development = gears[len(gears) - protocol.development :].tolist()
    episodes = list(protocol.episodes(table))
    judged = [target.gear for episode in episodes for target in episode.targets]
    assert sorted([*judged, *development]) == gears.tolist()
    for episode in episodes:
        known = set(table["gear"].iloc[episode.source])
        wanted = len(gears) - len(episode.targets)
        assert len(known) == min(wanted, protocol.sources or wanted)
        assert known <= set(development) or set(development) <= known  # development gears come first
        if protocol.development >= 2 and len(known) >= 2:
            chosen = protocol.development_episodes(table, episode)
            targets = [target.gear for each in chosen for target in each.targets]
            assert sorted(targets) == sorted(known & set(development))
            for each in chosen:
                sources = set(table["gear"].iloc[np.append(each.source, each.kept_out)])
                assert sources.isdisjoint(target.gear for target in episode.targets)
                assert sources == known - set(development) or known <= set(development)


@few
@given(grids(), st.integers(0, 3))
def test_shots_are_nested_whole_variants_of_the_labelled_pool_and_all_of_them_are_level_z4(grid, draw):
    table, protocol = grid
    target = next(iter(protocol.episodes(table))).targets[0]
    fewer = set()
    for number in range(protocol.labelled + 1):
        rows = target.shots(table, number, draw)
        assert np.isin(rows, target.labelled).all()
        found = table.iloc[rows]
        assert (found.groupby("label", observed=True)["variant"].nunique() == number).all()
        assert len(rows) == number * table["label"].nunique() * table["point"].nunique()  # at all operating points
        assert fewer <= set(rows)
        fewer = set(rows)
    assert np.array_equal(rows, target.labelled)


@few
@given(grids(), st.integers(0, 100))
def test_the_order_of_rows_changes_neither_pools_nor_shots(grid, seed):
    table, protocol = grid
    shuffled = table.iloc[np.random.default_rng(seed).permutation(len(table))].reset_index(drop=True)
    number = min(2, protocol.labelled)
    for one, other in zip(protocol.episodes(table), protocol.episodes(shuffled), strict=True):
        rows, same = [one.source, one.kept_out], [other.source, other.kept_out]
        for target, again in zip(one.targets, other.targets, strict=True):
            rows += [*pools(target), target.shots(table, number, 1)]
            same += [*pools(again), again.shots(shuffled, number, 1)]
        assert [named(table, each) for each in rows] == [named(shuffled, each) for each in same]


def first_target(table, gear=1, **options):
    protocol = NewGears(**{"folds": 2, "development": 0, "labelled": 3, "unlabelled": 1, "kept_out": 1, **options})
    return next(t for e in protocol.episodes(table) for t in e.targets if t.gear == gear)


def test_pools_and_shots_of_a_gear_do_not_change_with_other_gears_classes_or_numbers_of_folds():
    small, large = table_of(gears=3, labels=CLASSES[:2]), table_of(gears=5, labels=CLASSES)
    one, other = first_target(small), first_target(large, folds=4, development=1)
    of_small = large[large["label"].isin(CLASSES[:2])].index
    for pool, same in zip(pools(one), pools(other), strict=True):
        assert named(small, pool) == named(large, np.intersect1d(same, of_small))
    shots = np.intersect1d(other.shots(large, 2, 0), of_small)
    assert named(small, one.shots(small, 2, 0)) == named(large, shots)


def test_draws_classes_and_gears_have_shots_and_pools_of_their_own():
    table = table_of(gears=2, variants=12)
    targets = [first_target(table, gear, labelled=8) for gear in (1, 2)]
    draws = [tuple(targets[0].shots(table, 3, draw)) for draw in range(5)]
    assert len(set(draws)) == 5
    numbers = {
        (target.gear, label): tuple(sorted({s[2] for s in specimens(table, target.judged) if s[1] == label}))
        for target in targets
        for label in CLASSES[:2]
    }
    assert len(set(numbers.values())) == 4


def test_source_gears_and_their_variants_can_be_limited():
    table = table_of(gears=6)
    (first, *_) = NewGears(folds=4, development=2, labelled=2, unlabelled=1, sources=3).episodes(table)
    assert set(table["gear"].iloc[first.source]) == {6, 5, 4}
    assert set(table["variant"].iloc[first.source]) == {0, 1, 2, 3}
    assert set(table["variant"].iloc[first.kept_out]) == {4, 5}
    (limited, *_) = NewGears(folds=4, development=0, labelled=2, unlabelled=1, variants=2).episodes(table)
    assert set(table["variant"].iloc[limited.source]) == {0, 1}
    assert set(table["variant"].iloc[limited.kept_out]) == {4, 5}
    assert not any(pool.size == 0 for target in limited.targets for pool in pools(target))


def test_zero_shot_splits_train_on_the_source_and_test_the_judged_rows():
    table = table_of()
    protocol = NewGears(folds=2, development=2, labelled=2, unlabelled=1)
    splits = protocol.split(np.zeros((len(table), 1)), table)
    for split, episode in zip(splits, protocol.episodes(table), strict=True):
        assert split.name == episode.name
        assert np.array_equal(split.train, episode.source)
        assert set(split.test) == {row for target in episode.targets for row in target.judged}


def test_options_are_tried_with_about_as_many_source_gears_as_they_are_used_with():
    table = table_of(gears=12)
    protocol = NewGears(folds=5, development=3, labelled=2, unlabelled=1)
    for episode in protocol.episodes(table):
        (chosen,) = protocol.development_episodes(table, episode)
        assert [target.gear for target in chosen.targets] == [10, 11, 12]
        used, tried = (table["gear"].iloc[each.source].nunique() for each in (episode, chosen))
        assert tried == used - 3


def test_development_gears_are_left_out_in_turn_where_they_are_the_only_sources():
    table = table_of(gears=6)
    protocol = NewGears(folds=2, development=4, labelled=2, unlabelled=1, sources=2)
    chosen = protocol.development_episodes(table, next(iter(protocol.episodes(table))))
    assert [set(table["gear"].iloc[each.source]) for each in chosen] == [{6}, {5}]
    assert [[target.gear for target in each.targets] for each in chosen] == [[5], [6]]


def test_more_shots_than_labelled_variants_are_refused():
    table = table_of()
    with pytest.raises(ValueError, match="4 shots of healthy requested, gear 1 has 3 labelled variants: take fewer"):
        first_target(table).shots(table, 4, 0)
    with pytest.raises(ValueError, match="1 shots requested, gear 1 has 0 labelled variants: set labelled"):
        first_target(table, labelled=0).shots(table, 1, 0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"labelled": 4, "unlabelled": 2}, "gear 1 has 6 variants of healthy, 4 labelled and 2 .* leave 0 to judge"),
        ({"development": 4}, "0 gears to judge of 4 in all, with 4 for development"),
        ({"development": 5}, "0 gears to judge of 4 in all, with 5 for development"),
        ({"kept_out": 6}, "6 variants, of which 6 are kept out, leave 0 for training: keep out fewer"),
    ],
)
def test_a_grid_that_is_too_small_is_refused(change, message):
    protocol = replace(NewGears(folds=2, development=0, labelled=2, unlabelled=1), **change)
    with pytest.raises(ValueError, match=message):
        list(protocol.episodes(table_of()))


@pytest.mark.parametrize(
    ("name", "value", "low"),
    [
        ("folds", 1, 2),
        *((name, -1, 0) for name in ("development", "labelled", "unlabelled", "kept_out")),
        *((name, 0, 1) for name in ("variants", "sources", "judged")),
    ],
)
def test_numbers_out_of_their_limits_are_refused(name, value, low):
    with pytest.raises(ValueError, match=f"{name} of the protocol is {value}, must be an integer from {low}"):
        NewGears(**{name: value})


def test_one_source_gear_leaves_no_options_to_choose():
    table = table_of(gears=3)
    protocol = NewGears(folds=2, development=2, labelled=0, unlabelled=0, kept_out=0, sources=1)
    assert [protocol.development_episodes(table, each) for each in protocol.episodes(table)] == [[]]
