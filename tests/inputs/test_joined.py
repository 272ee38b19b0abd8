"""Gears of two data sets as one: who is judged, and who trains."""

import numpy as np
import pytest
from fabricated import recordings

from learn.inputs.inputs import with_foreign_gears, with_training_gears
from learn.inputs.signals import Signals
from learn.protocols.levels import NewGears

DATA, FURTHER = (Signals("template", 16, 6).learning_set([recordings(gears=gears)]) for gears in (3, 4))
POOLS = NewGears(development=0, judged=2, labelled=1, unlabelled=1, kept_out=0, sources=4)


def only_episode(data):
    (episode,) = POOLS.episodes(data.table)
    return episode


def test_training_gears_are_the_sources_and_the_judged_recordings_stay():
    alone, joined = only_episode(DATA), only_episode(both := with_training_gears(DATA, FURTHER))
    for before, after in zip(alone.targets, joined.targets, strict=True):
        assert before.gear == after.gear
        np.testing.assert_array_equal(before.judged, after.judged)
        np.testing.assert_array_equal(DATA.features[before.judged], both.features[after.judged])
    np.testing.assert_array_equal(both.features[joined.source], FURTHER.features)
    assert both.table.loc[joined.source, "gear"].unique().tolist() == [4, 5, 6, 7]


def test_foreign_gears_are_judged_and_the_data_set_trains():
    both = with_foreign_gears(DATA, FURTHER)
    episode = only_episode(both)
    assert [target.gear for target in episode.targets] == [-3, -2]
    np.testing.assert_array_equal(both.features[-len(DATA.features) :], DATA.features)
    assert set(DATA.table["gear"]) < set(both.table.loc[episode.source, "gear"])


def test_other_inputs_are_refused():
    other = Signals("template", 16, 6, efficiency=False).learning_set([recordings(gears=1)])
    with pytest.raises(ValueError, match=r"8[0-9] and 8[0-9] inputs that differ"):
        with_training_gears(DATA, other)
