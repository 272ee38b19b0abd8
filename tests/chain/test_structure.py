"""Influence maps are remembered, and interpolated where only the scale of the displacement differs."""

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS, map_of

from swgsim.chain import structure
from swgsim.effects import EccentricWaveGenerator, RootToothCrack, TipToothCrack
from swgsim.effects.frozen import ScaledDisplacement

BESIDE = [(), (EccentricWaveGenerator(1e-5, 0.3),), (RootToothCrack(0.05, 2.3),), (TipToothCrack(1.0, 0.3),)]


def scaled(factors, beside=()):
    """Influence map of the gear with displacements scaled, beside other effects."""
    effects = (*map(ScaledDisplacement, factors), *beside)
    return structure.map_of(structure.Structure.of(GEAR, effects, 0.0), SECTORS)


@pytest.mark.parametrize("beside", BESIDE)
@pytest.mark.parametrize("factors", [(0.9951,), (1.0, 1.0037), (1.003, 0.97)])
def test_maps_of_other_scales_are_interpolated_far_below_any_noise(factors, beside):
    exact = map_of(*map(ScaledDisplacement, factors), *beside).coefficients
    found = scaled(factors, beside).coefficients
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-6 * np.abs(exact).max())


def test_many_scales_need_few_maps():
    structure._computed.cache_clear()
    for factor in np.linspace(1.001, 1.009, 50).tolist():
        scaled((factor,))
    assert structure._computed.cache_info().misses == len(structure.AROUND)


@pytest.mark.parametrize("factors", [(0.301,), (1.995,), (0.5, 0.5)])
def test_scales_near_or_beyond_a_bound_are_computed(factors):
    exact = map_of(*map(ScaledDisplacement, factors)).coefficients
    np.testing.assert_array_equal(scaled(factors).coefficients, exact)


def test_scales_with_another_displacement_between_them_are_computed():
    effects = (ScaledDisplacement(1.01), EccentricWaveGenerator(1e-5, 0.3), ScaledDisplacement(1.02))
    found = structure.map_of(structure.Structure.of(GEAR, effects, 0.0), SECTORS)
    np.testing.assert_array_equal(found.coefficients, map_of(*effects).coefficients)
