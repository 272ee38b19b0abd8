"""Which physics changes the shape of a signal, and which does not."""

import pytest

from swgsim.studies.shapes import C3_CASES, cracked, eccentric

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
