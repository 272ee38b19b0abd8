"""Which physics gives the shapes of the paper's pictures, and which does not."""

import pytest

from swgsim.studies.claims import eccentric_wave_generator, reduced_stiffness, root_tooth_crack
from swgsim.studies.shapes import CASES, WITHOUT_TORQUE, seen_tips, turning_shape


@pytest.mark.parametrize("case", CASES)
def test_each_picture_needs_its_own_physics(case):
    subject = CASES[case]
    assert not reduced_stiffness(subject).holds
    assert eccentric_wave_generator(subject).holds == (case == "load on the deepest teeth")
    assert root_tooth_crack(subject).holds == (case == "cracks over ten teeth")


def test_an_eccentricity_that_turns_in_part_distorts_the_signals():
    assert turning_shape(CASES["as it is"]) > 0.01


def test_tip_cracks_at_little_load_are_seen_if_they_are_wide_or_the_mesh_carries_load_without_torque():
    plain, wide = CASES["as it is"], CASES["cracks over ten teeth"]
    assert seen_tips(plain, 7) < 0.6  # of all three loads 90 % must be seen, so of this one 70 %
    assert min(seen_tips(wide, 7), seen_tips(plain, 7 + WITHOUT_TORQUE)) > 0.7
