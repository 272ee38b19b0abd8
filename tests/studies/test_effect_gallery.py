"""The page of the effects: none of its pictures is empty, and it says where an effect is shown."""

import re

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS

from swgsim.effects.flange_zero import FlangeZero
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.library import SEARCHED
from swgsim.effects.lost_motion import LostMotion
from swgsim.effects.stribeck_friction import StribeckFriction
from swgsim.effects.torque_nonlinearity import TorqueNonlinearity
from swgsim.effects.worn_wave_generator import WornWaveGenerator
from swgsim.studies import effect_gallery, effect_signature
from swgsim.studies.effect_gallery import picture, row, title
from swgsim.studies.effect_signature import (
    OTHER_SETTINGS,
    ROUNDING_SHARE,
    USUAL,
    Signature,
    pattern,
    signatures,
)

KINDS = (LostMotion, StribeckFriction, TorqueNonlinearity, FlangeZero, GaugeGain, WornWaveGenerator)


@pytest.fixture(scope="module")
def found():
    return dict(zip(KINDS, signatures(KINDS, GEAR, SECTORS), strict=True))


@pytest.mark.end_to_end
def test_every_effect_changes_something_where_it_is_shown():
    assert all(signature.top[0] > ROUNDING_SHARE for signature in signatures(SEARCHED, GEAR, SECTORS))


@pytest.mark.parametrize("kind", OTHER_SETTINGS)
def test_an_effect_is_shown_elsewhere_only_where_the_usual_setting_hides_it(kind, monkeypatch):
    monkeypatch.setattr(effect_signature, "OTHER_SETTINGS", {})
    with pytest.raises(ValueError, match=rf"{kind.name()} changes nothing at 2000 rpm, 70 N m .* OTHER_SETTINGS"):
        signatures([kind], GEAR, SECTORS)


def test_lost_motion_shows_in_many_orders_and_the_panel_says_where(found):
    signature = found[LostMotion]
    assert (signature.share[0, 2, 12::12] > 1e-3).sum() >= 5
    assert title(signature).startswith("lost motion\nat 750 rpm, 0.7 N m, with kinematic")
    assert "`lost_motion` at 750 rpm, 0.7 N m, with kinematic error order" in effect_gallery.HEAD


def test_stribeck_friction_shows_in_the_mean_of_the_input_torque_at_every_load(found):
    signature = found[StribeckFriction]
    assert signature.where == (1, 0)
    assert title(signature).startswith("Stribeck friction\nat 200 rpm, 70 N m\n")
    load, speed = map(float, signature.growth)
    assert load == pytest.approx(1, rel=0.02)
    assert speed < 1


def test_changes_are_those_of_the_channels(found):
    assert found[FlangeZero].setting == USUAL
    np.testing.assert_allclose(found[FlangeZero].change[:, 1, 0], 0.005)
    assert found[FlangeZero].growth == ("1", "1")
    assert found[FlangeZero].over_gauges == "-"
    assert found[GaugeGain].over_gauges.endswith("in s1 alone")
    assert found[WornWaveGenerator].over_gauges == "order 2: opposite in neighbours (two waves)"


def test_patterns_are_told_by_signs_and_phases():
    assert pattern(np.array([0j, 1, -1, 1, -1])) == "opposite in neighbours (two waves)"
    assert pattern(np.array([2j, 1j, 1j, 1j, 1j])) == "the same in all gauges"
    assert pattern(2j * np.array([0, 1, 1j, -1, -1j])).startswith("one wave that turns against")
    assert pattern(np.array([0j, 1, 1, -1, -1])) == "several patterns"


def test_the_same_picture_has_the_same_bytes(found):
    once, again = (picture(list(found.values())) for _ in range(2))
    assert once == again


def test_a_row_has_one_cell_per_column(found):
    for line in map(row, found.values()):
        assert len(re.findall(r"(?<!\\)\|", line)) == effect_gallery.HEADER.partition("\n")[0].count("|")


def test_an_empty_panel_is_an_error():
    nothing = np.zeros((3, 8, 145), complex)
    with pytest.raises(ValueError, match=r"gauge_gain changes nothing at 2000 rpm, 70 N m"):
        Signature(GaugeGain, nothing, np.ones((3, 8)))
