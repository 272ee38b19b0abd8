"""Effects stay within physical limits and touch only their own place."""

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS

from swgsim.chain.influence import boundary_conditions, fine_angles
from swgsim.dataset.faults import FAULTS, Variants
from swgsim.effects import (
    CamForm,
    EccentricWaveGenerator,
    Effect,
    ParameterScatter,
    ReducedDamping,
    ReducedStiffness,
    RootToothCrack,
    TipToothCrack,
    WarmGrease,
)
from swgsim.flexspline.flexspline import solve_flex_spline

EFFECTS = [
    ReducedDamping(0.7),
    ReducedStiffness(0.9),
    EccentricWaveGenerator(5e-5, 1.0),
    RootToothCrack(0.1, 1.0),
    TipToothCrack(0.5, 1.0),
    CamForm(3, 2e-6),
    WarmGrease(10.0),
    ParameterScatter(1.01, 0.99),
]
PLACES = {
    "gear": (ReducedDamping, ReducedStiffness, WarmGrease, ParameterScatter),
    "wave_generator": (EccentricWaveGenerator, CamForm),
    "mesh": (TipToothCrack,),
    "cracks": (RootToothCrack,),
}


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda e: type(e).__name__)
def test_an_effect_changes_its_place_and_nothing_else(effect: Effect) -> None:
    psi, theta = np.linspace(0, 6, 5), 2 * np.pi / 40 * np.arange(40)
    field = np.ones((5, 40))
    changed = {
        "gear": effect.gear(GEAR) != GEAR,
        "wave_generator": not np.array_equal(effect.wave_generator(field, psi, theta), field),
        "mesh": not np.array_equal(effect.mesh(field, psi, theta), field),
        "cracks": effect.cracks() != (),
    }
    assert changed == {place: isinstance(effect, kinds) for place, kinds in PLACES.items()}


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ReducedDamping(0.1), "b1_ratio of reduced damping is 0.1, must be a finite number from 0.3 to 1"),
        (lambda: ReducedStiffness(1.2), "k1_ratio of reduced stiffness is 1.2, must be .* from 0.5 to 1"),
        (lambda: EccentricWaveGenerator(2e-4, 0.0), "r of eccentric wave generator is 0.0002, .* to 0.00015"),
        (lambda: RootToothCrack(0.0, 0.0), "stiffness_ratio of root tooth crack is 0.0, .* from 0.001 to 1"),
        (lambda: TipToothCrack(1.5, 0.0), "force_loss of tip tooth crack is 1.5, .* from 0 to 1"),
        (lambda: TipToothCrack(0.5, float("nan")), "theta of tip tooth crack is nan"),
        (lambda: CamForm(3, 1e-3), "amplitude of cam form is 0.001"),
        (lambda: WarmGrease(200.0), "dT of warm grease is 200.0"),
    ],
)
def test_beyond_physical_limits_the_error_names_the_limit(make: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_tip_crack_takes_the_width_of_its_teeth() -> None:
    theta = 2 * np.pi / 1000 * np.arange(1000)
    share = TipToothCrack(1.0, 1.0, width=4 * 2 * np.pi / 200).mesh(np.ones((1, 1000)), np.zeros(1), theta)
    assert 1000 - share.sum() == pytest.approx(1000 * 4 / 200)


def test_the_force_of_a_cracked_tip_is_taken_over_or_lost() -> None:
    """By four teeth of 200 at the middle of a lobe: cos 2 theta over +-45 degrees of each of two."""
    flex = solve_flex_spline(GEAR.flex_spline, GEAR.transmission.alpha_tooth, SECTORS)
    psi = np.zeros(1)
    depth = np.cos(2 * fine_angles(SECTORS))[None]
    sums = [
        boundary_conditions(flex, depth, [TipToothCrack(1.0, 0.0, taken_over=taken_over)], psi)[1].sum()
        for taken_over in (1, 0)
    ]
    assert sums[0] * flex.tooth_radius == pytest.approx(1)
    assert sums[1] / sums[0] == pytest.approx(1 - 4 * 2 * np.pi / 200 / 2, rel=1e-3)


SEVERITIES = {label: (0.7, 0.9) for label in FAULTS} | {"eccentric_wave_generator": (1e-5, 1e-4)}


def test_table_v_has_every_severity_at_every_position() -> None:
    variants = list(Variants(40, 20, SEVERITIES).of("root_tooth_crack", np.random.default_rng(0)))
    assert len({(v.severity, v.position) for v in variants}) == 40
    assert {v.severity for v in variants} == {0.7, 0.9}
    np.testing.assert_allclose(sorted({v.position for v in variants}), 2 * np.pi / 20 * np.arange(20))


def test_damping_and_stiffness_take_even_steps_without_position() -> None:
    variants = list(Variants(40, 20, SEVERITIES).of("reduced_damping", np.random.default_rng(0)))
    np.testing.assert_allclose([v.severity for v in variants], np.linspace(0.7, 0.9, 40))
    assert all(np.isnan(v.position) for v in variants)


def test_bad_variants_are_refused() -> None:
    with pytest.raises(ValueError, match="2 severities x 20 positions do not make 60 variants"):
        Variants(60, 20, SEVERITIES)
    with pytest.raises(ValueError, match="variants of the grid is 0, must be an integer from 1"):
        Variants(0, 1, SEVERITIES)
    with pytest.raises(ValueError, match="unknown choice 'broken' of the classes; choose from healthy"):
        next(Variants(40, 20, SEVERITIES).of("broken", np.random.default_rng(0)))
    with pytest.raises(ValueError, match="expected one list for each of"):
        Variants(40, 20, {"reduced_damping": (0.7, 0.9)})
