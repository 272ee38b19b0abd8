"""Factors of another structure: waves around the circumference stay waves, equally at all gauges."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS, flex_spline

from swgsim.chain.influence import influence_map
from swgsim.effects.rotating_eccentricity import RotatingEccentricity
from swgsim.flexspline.flexspline import TEETH, WAVE_GENERATOR, gauge_response
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, WAVES, StructureFactors, smooth_modes
from swgsim.gear.gear import gear_from


def logs(**of_waves: complex) -> tuple[float, ...]:
    """Logarithms of factors of some wave numbers, such as ``n2=0.5``; 0 for all others."""
    found = np.array([of_waves.get(f"n{n}", 0j) for n in range(WAVES)])
    return (*found.real.tolist(), *found.imag.tolist())


def map_with(factors: StructureFactors, *effects) -> np.ndarray:
    return influence_map(flex_spline(SECTORS), GEAR.wave_generator, GEAR.gauges, effects, factors).coefficients


def test_a_structure_without_factors_is_that_of_the_truss_to_the_last_bit() -> None:
    flex = flex_spline(SECTORS)
    assert gauge_response(flex, GEAR.gauges, EXACT_STRUCTURE) is gauge_response(flex, GEAR.gauges)
    assert GEAR.factors == EXACT_STRUCTURE


@pytest.mark.parametrize(("kind", "load"), [("wave_generator", WAVE_GENERATOR), ("teeth", TEETH)])
def test_a_factor_changes_its_wave_and_kind_of_load_equally_at_the_four_gauges(kind, load) -> None:
    """In a sound gear the wave of number 2 is order 2, by its amplitude and its phase; s0 has its own factors."""
    log = 0.4 + 0.3j
    sound, found = map_with(EXACT_STRUCTURE), map_with(StructureFactors(**{kind: logs(n2=log)}))
    expected = sound.copy()
    # Waves of number 2 that turn with the lobes go as exp(-2j psi), so order 2 has the conjugate factor.
    expected[load, 1:, 2] *= np.exp(np.conj(log))
    # On a coarse mesh the forces of the teeth ripple a little as nodes pass.
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=0.01 * np.abs(sound[load, 1:, 2]).max())
    of_s0 = map_with(StructureFactors(**{f"{kind}_s0": logs(n4=log)}))
    np.testing.assert_array_equal(of_s0[:, 1:], sound[:, 1:])
    assert of_s0[load, 0, 4] == pytest.approx(sound[load, 0, 4] * np.exp(np.conj(log)), rel=0.01)


def test_an_effect_of_one_wave_is_as_large_as_the_factor_of_that_wave() -> None:
    """What a healthy gear cannot tell: a rotating eccentricity without load, on a structure twice as soft for n = 1."""
    eccentric = RotatingEccentricity(1e-5)
    soft = StructureFactors(wave_generator=logs(n1=np.log(2)))
    one, two = ((map_with(factors, eccentric) - map_with(factors))[0, 1:, 1] for factors in (EXACT_STRUCTURE, soft))
    np.testing.assert_allclose(two, 2 * one, rtol=1e-9)


def test_a_gear_with_factors_is_written_and_read() -> None:
    gear = replace(GEAR, factors=StructureFactors(teeth=logs(n2=0.4 + 0.3j)))
    assert gear_from(json.loads(json.dumps(asdict(gear)))) == gear


def test_modes_have_the_covariance_of_a_smooth_course() -> None:
    modes, n = smooth_modes(2.0, 1e-9), np.arange(WAVES)
    np.testing.assert_allclose(modes.T @ modes, np.exp(-((n[:, None] - n) ** 2) / 8), atol=1e-9)
    assert len(smooth_modes(2.0, 0.1)) < len(modes)


def test_factors_of_too_few_waves_are_refused() -> None:
    with pytest.raises(ValueError, match="must have none or 26 finite values"):
        replace(EXACT_STRUCTURE, teeth=(1.0, 2.0))
