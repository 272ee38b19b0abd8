"""Influence maps: symmetry, rotation, superposition, convergence, and the direct solver."""

import numpy as np
import pytest
from chain_fixtures import GEAR, amplitude, flex_spline, map_of

from swgsim.chain.direct import DirectSolver
from swgsim.chain.influence import boundary_conditions, ellipse, fine_angles
from swgsim.dataset.faults import widened
from swgsim.effects import CamForm, EccentricWaveGenerator, Effect, RootToothCrack, TipToothCrack
from swgsim.studies.convergence import study

PSI = np.linspace(0, 2 * np.pi, 97)
FAULTS = [
    (),
    (EccentricWaveGenerator(1e-4, 0.3),),
    (RootToothCrack(0.02, 2.3),),
    (TipToothCrack(1.0, 0.3),),
    (RootToothCrack(0.1, 1.0), RootToothCrack(0.05, 4.0), CamForm(3, 2e-6, 0.4)),
    widened(RootToothCrack(0.05, 1.0), 5),
]


@pytest.mark.parametrize("effects", FAULTS)
def test_chain_agrees_with_one_sparse_solve_per_instant(effects: tuple[Effect, ...]) -> None:
    psi, torque = np.linspace(0.1, 6.0, 12), np.linspace(7, 70, 12)
    direct = DirectSolver(flex_spline(100), GEAR, effects).signals(psi, torque)
    A, B = map_of(*effects, sectors=100)(psi)
    assert np.abs(A + torque * B - direct).max() < 1e-5 * amplitude(direct[1])


def test_opposite_gauges_of_a_perfect_gear_agree() -> None:
    A, B = map_of()(PSI)
    for signals in (A, B):
        np.testing.assert_allclose(signals[1], signals[3], atol=1e-9 * np.abs(signals).max())
        np.testing.assert_allclose(signals[2], signals[4], atol=1e-9 * np.abs(signals).max())


def test_torque_bridge_is_nearly_flat() -> None:
    A, B = map_of()(PSI)
    assert amplitude(A[0]) < 0.03 * amplitude(A[1])
    assert amplitude(B[0]) < 0.02 * B[0].mean()


@pytest.mark.parametrize("make", [lambda t: RootToothCrack(0.05, t), lambda t: TipToothCrack(1.0, t)])
def test_a_crack_one_gauge_pitch_further_permutes_the_gauges(make: object) -> None:
    """Turning crack and wave generator by a quarter turn gives s_(i+1) what s_i had."""
    for sectors in (60, 100):
        for position in (0.0, 0.35, *2 * np.pi / 20 * np.arange(1, 5)):
            first, turned = (map_of(make(angle), sectors=sectors) for angle in (position, position + np.pi / 2))
            before, after = first(PSI), turned(PSI + np.pi / 2)
            for now, then in ((2, 1), (3, 2), (4, 3), (1, 4), (0, 0)):
                np.testing.assert_allclose(after[:, now], before[:, then], atol=1e-9 * np.abs(before).max())


def test_compliances_of_cracks_in_the_same_gap_add() -> None:
    """The bars are weakened over two tooth pitches instead of one."""
    twice, once = map_of(*[RootToothCrack(0.1, 1.0)] * 2), map_of(RootToothCrack(1 / 19, 1.0))
    np.testing.assert_allclose(twice(PSI), once(PSI))


@pytest.mark.parametrize("sectors", [60, 160])
def test_a_crack_over_ten_teeth_changes_order_2_equally_on_any_mesh(sectors: int) -> None:
    changes = []
    for mesh in (sectors, 100):
        sound, cracked = (map_of(*e, sectors=mesh) for e in ((), widened(RootToothCrack(0.03, 0.3), 10)))
        changes.append(np.abs(cracked.coefficients - sound.coefficients)[0, 1:, 2].max())
    assert changes[0] == pytest.approx(changes[1], rel=0.1)


def test_torque_adds_up_and_shifts_superpose() -> None:
    """The truss is linear: the signals of two eccentricities add up, and those of a load and of no load."""
    one, two = EccentricWaveGenerator(3e-5, 0.2), EccentricWaveGenerator(5e-5, 2.0)
    direct = DirectSolver(flex_spline(), GEAR, (one,))
    unloaded, half, full = (direct.signals(PSI[:4], np.full(4, load)) for load in (0.0, 35.0, 70.0))
    np.testing.assert_allclose(full - unloaded, 2 * (half - unloaded), atol=1e-12)
    sound, first, second, both = (m(PSI)[0] for m in (map_of(), map_of(one), map_of(two), map_of(one, two)))
    np.testing.assert_allclose(both - sound, (first - sound) + (second - sound), atol=1e-12)


def test_tooth_forces_carry_the_torque_whatever_the_fault() -> None:
    flex = flex_spline()
    for effects in FAULTS:
        ideal = ellipse(GEAR.wave_generator, GEAR.flex_spline.radius, PSI, fine_angles(flex.sector.count))
        _, force = boundary_conditions(flex, ideal, effects, PSI)
        np.testing.assert_allclose(force.sum(axis=1) * flex.tooth_radius, 1)
        assert force.min() >= 0


def test_ellipse_has_the_fourth_harmonic_of_an_ellipse() -> None:
    """w4 / w2 = 3 w0 / (4 R) to first order, 0.75 % for w0 = R / 100."""
    theta = 2 * np.pi / 64 * np.arange(64)
    w = np.abs(np.fft.rfft(ellipse(GEAR.wave_generator, GEAR.flex_spline.radius, np.zeros(1), theta)[0])) / 32
    assert w[2] == pytest.approx(GEAR.wave_generator.w0, rel=1e-3)
    assert w[4] / w[2] == pytest.approx(0.75 * GEAR.wave_generator.w0 / GEAR.flex_spline.radius, rel=0.02)


def test_convergence_with_the_mesh() -> None:
    """Torque sensitivity converges at second order; the default mesh is within 2 % of one four times as large."""
    table = study(GEAR, (40, 60, 80, 100, 120, 160, 200, 240))
    torque, deflection = table["torque"], table["deflection"]
    for n in (40, 60):
        rate = np.log2((torque[n] - torque[2 * n]) / (torque[2 * n] - torque[4 * n]))
        assert 1.6 < rate < 2.4
    assert abs(torque[100] / torque[240] - 1) < 0.003
    assert abs(deflection[100] / deflection[240] - 1) < 0.02
    assert abs(deflection[200] / deflection[240] - 1) < abs(deflection[80] / deflection[240] - 1)
