"""Effects stay within physical limits and touch only their own place."""

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS

from swgsim import effects
from swgsim.chain.influence import boundary_conditions, fine_angles
from swgsim.dataset.faults import FAULTS, Variants
from swgsim.effects import LIBRARY, Effect, OutputPosition, TipToothCrack
from swgsim.effects.base import overrides
from swgsim.effects.bearing_order import BearingOrder
from swgsim.effects.quantity import Role, quantities
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.studies.effect_signature import typical

ACTS_AT = {
    "gear": {"gear"},
    "drive": {"drive"},
    "wave generator": {"wave_generator", "engaged"},
    "mesh": {"mesh", "carried"},
    "structure": {"cracks"},
    "gauge": {"gauge"},
    "acquisition": {"acquisition"},
}


@pytest.mark.parametrize("kind", LIBRARY.values(), ids=list(LIBRARY))
def test_an_effect_changes_its_place_and_nothing_else(kind: type[Effect]) -> None:
    effect = typical(kind).at(OperatingPoint(2000, 70), Conditions(45, 1800))
    acting = {method for methods in ACTS_AT.values() for method in methods if overrides(effect, method)}
    # A line between the orders has no influence map, so it is added to the signals.
    assert acting
    assert acting <= ({"gauge"} if isinstance(effect, BearingOrder) else ACTS_AT[kind.place])
    psi, theta = np.linspace(0, 6, 5), 2 * np.pi / 40 * np.arange(40)
    field = np.cos(2 * (theta - psi[:, None]))
    changed = {
        "gear": effect.gear(GEAR) != GEAR,
        "wave_generator": not np.array_equal(effect.wave_generator(field, psi, theta), field),
        "mesh": not np.array_equal(effect.mesh(np.abs(field), psi, theta), np.abs(field)),
        "cracks": effect.cracks() != (),
    }
    # The typical output position is the one at which a run begins.
    expected = (acting & set(changed)) - ({"gear"} if kind is OutputPosition else set())
    assert {method for method, changes in changed.items() if changes} == expected


def refused(kind: type[Effect], name: str, value: float, message: str) -> None:
    parameters = {each: quantity.typical for each, quantity in quantities(kind).items()} | {name: value}
    with pytest.raises(ValueError, match=f"{name} of {kind.title()} is .*, must be {message}"):
        kind(**parameters)


@pytest.mark.parametrize("kind", LIBRARY.values(), ids=list(LIBRARY))
def test_beyond_its_bounds_an_effect_is_refused_with_them(kind: type[Effect]) -> None:
    """Every parameter of every effect; sizes have a typical value and one that changes nothing within the bounds."""
    assert kind.place in effects.base.PLACES
    declared = quantities(kind)
    assert [each.role for each in declared.values()].count(Role.SIZE) >= (kind is not OutputPosition)
    for name, q in declared.items():
        if q.role is Role.SIZE:
            assert q.low <= q.nothing <= q.high
        assert q.low <= q.typical <= q.high
        if q.among:
            message, bad = f"one of {q.low:g}, ", (q.low - 1, q.high + 1, np.nan)
        elif q.role is Role.CHOICE:
            message, bad = f"an integer from {q.low:g} to {q.high:g}", (int(q.low) - 1, int(q.high) + 1)
        elif q.role in (Role.SIZE, Role.SHAPE):
            step = 1e-3 * (q.high - q.low)
            message, bad = f"a finite number from {q.low:g} to {q.high:g}", (q.low - step, q.high + step, np.nan)
        else:
            message, bad = "a finite number", (np.nan, np.inf)
        for value in bad:
            refused(kind, name, value, message)


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


def test_cracks_take_as_many_teeth_as_a_node_of_a_coarse_truss() -> None:
    variants = Variants(40, 20, SEVERITIES, crack_teeth=10)
    rng = np.random.default_rng(0)
    (tip,) = next(variants.of("tip_tooth_crack", rng)).effects
    roots = next(variants.of("root_tooth_crack", rng)).effects
    assert tip.width == pytest.approx(2 * np.pi / 20)
    np.testing.assert_allclose([root.theta for root in roots], 2 * np.pi / 200 * (np.arange(10) - 4.5))
    assert len(next(variants.of("eccentric_wave_generator", rng)).effects) == 1
    with pytest.raises(ValueError, match="crack_teeth of the grid is 11, must be an integer from 1 to 10"):
        Variants(40, 20, SEVERITIES, crack_teeth=11)


def test_bad_variants_are_refused() -> None:
    with pytest.raises(ValueError, match="2 severities x 20 positions do not make 60 variants"):
        Variants(60, 20, SEVERITIES)
    with pytest.raises(ValueError, match="variants of the grid is 0, must be an integer from 1"):
        Variants(0, 1, SEVERITIES)
    with pytest.raises(ValueError, match="unknown choice 'broken' of the classes; choose from healthy"):
        next(Variants(40, 20, SEVERITIES).of("broken", np.random.default_rng(0)))
    with pytest.raises(ValueError, match="expected one list for each of"):
        Variants(40, 20, {"reduced_damping": (0.7, 0.9)})
