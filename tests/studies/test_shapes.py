"""Which physics changes the shape of a signal, and which does not."""

import pytest

from swgsim.studies.shapes import C3_CASES, C9_CASES, cracked, departing, eccentric

SECTORS = 100


@pytest.mark.parametrize("case", C3_CASES)
def test_an_eccentric_wave_generator_distorts_s1_where_the_load_is_on_few_teeth_or_it_turns(case):
    offsets, shape = eccentric(case, SECTORS)
    assert offsets[0] == pytest.approx(-offsets[1], abs=0.02)
    assert (shape >= 0.01) == (
        case in ("load on the deepest teeth", "10 µm of the eccentricity turn with the wave generator")
    )


def test_a_longer_crack_reaches_all_gauges():
    short, long = cracked(1, SECTORS), cracked(7, SECTORS)
    assert short[0] < 0.01 < long[0]
    assert short[1] < long[1]


def test_tip_cracks_at_little_load_are_seen_if_they_are_wide_or_the_mesh_carries_load_without_torque():
    as_it_is, wide, preloaded = (departing(*case, load=7, sectors=SECTORS) for case in C9_CASES.values())
    assert as_it_is < 0.6  # of all three loads 90 % must be seen, so of this one 70 %
    assert min(wide, preloaded) > 0.7
