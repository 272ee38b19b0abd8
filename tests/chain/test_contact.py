"""Wave generator that only presses: complementarity, limits, and the direct solver."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR, amplitude, flex_spline

from swgsim.chain import contact
from swgsim.chain.contact import pressed
from swgsim.chain.direct import DirectSolver
from swgsim.chain.influence import LOAD_STEP, PSI, boundary_conditions, ellipse, fine_angles, influence_map
from swgsim.effects import EccentricWaveGenerator, TipToothCrack
from swgsim.flexspline.flexspline import TEETH, WAVE_GENERATOR, FlexSpline
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, WAVES, StructureFactors
from swgsim.gear.gear import Gear, WaveGenerator

SECTORS = 60
FLEX = flex_spline(SECTORS)
LOAD = 10 * LOAD_STEP


def with_fit(interference: float) -> Gear:
    return replace(GEAR, wave_generator=WaveGenerator(presses_only=True, interference=interference))


def asked_and_forces(gear: Gear, load: float, flex: FlexSpline = FLEX) -> list[np.ndarray]:
    """Circumferential orders of the displacement asked for and of the tooth forces, over the angles of a map."""
    sectors = flex.sector.count
    cam = ellipse(gear.wave_generator, GEAR.flex_spline.radius, PSI, fine_angles(sectors))
    displacement, per_torque = boundary_conditions(flex, cam, (), PSI)
    fields = displacement + gear.wave_generator.interference, load * per_torque
    return [np.fft.rfft(field, axis=1) / sectors for field in fields]


def test_the_sleeve_is_touched_and_pressed_or_free_and_further_out() -> None:
    flex, count = flex_spline(contact.POINTS), contact.POINTS // 2
    asked, forces = asked_and_forces(with_fit(0.0), LOAD, flex)
    displacement = pressed(flex, EXACT_STRUCTURE, asked, forces, PSI)
    compliance = flex.compliance[:count]
    force = (displacement[:, :count] - compliance[:, TEETH] * forces[:, :count]) / compliance[:, WAVE_GENERATOR]
    # The bearing is compressed, so the displacement is smaller than that of the wave generator.
    bearing = contact.BEARING_STIFFNESS * 2 * np.pi * GEAR.flex_spline.radius / contact.POINTS
    turn = np.exp(1j * np.outer(PSI, np.arange(count)))
    pressing, gap = (
        contact.POINTS * np.fft.irfft(field * turn, contact.POINTS, axis=1)
        for field in (force, displacement[:, :count] - asked[:, :count] + force / bearing)
    )
    touching = pressing > 5e-3 * pressing.max()
    assert 0.4 < touching.mean() < 0.9
    assert pressing.min() > -5e-3 * pressing.max()  # without the highest order
    assert np.abs(gap[touching]).max() < 2e-3 * GEAR.wave_generator.w0
    assert gap[~touching].min() > -2e-3 * GEAR.wave_generator.w0


def test_with_much_interference_the_sleeve_follows_all_around() -> None:
    tight, loose = (
        influence_map(FLEX, with_fit(fit).wave_generator, GEAR.gauges, load=LOAD)(PSI) for fit in (1e-4, 0.0)
    )
    paper = influence_map(FLEX, GEAR.wave_generator, GEAR.gauges)(PSI)
    tight, loose, paper = (each[0] + LOAD * each[1] for each in (tight, loose, paper))
    off = np.abs(tight - paper)[1:].max() / amplitude(paper[1])
    assert off < 0.1  # what the bearing gives way under the tooth forces
    assert np.abs(loose - paper)[1:].max() > 3 * off * amplitude(paper[1])


@pytest.mark.parametrize("effects", [(), (EccentricWaveGenerator(2e-5, 0.3),), (TipToothCrack(0.8, 1.0),)])
def test_map_agrees_with_one_solve_per_instant_at_every_load(effects: tuple) -> None:
    gear = with_fit(0.0)
    psi = np.array([0.1, 1.3, 2.7])
    direct = DirectSolver(FLEX, gear, effects)
    for steps in (2, 20):
        load = steps * LOAD_STEP
        A, B = influence_map(FLEX, gear.wave_generator, gear.gauges, effects, load=load)(psi)
        for torque in (load, load + LOAD_STEP / 2):
            found = direct.signals(psi, np.full(3, torque))
            assert np.abs(A + torque * B - found).max() < 0.005 * np.abs(found).max()


def test_an_eccentricity_shows_at_even_orders_where_the_sleeve_lifts_off() -> None:
    """Imposed all around, it only moves the offsets at no load; where it presses, it acts while a lobe passes."""
    eccentric = (EccentricWaveGenerator(2e-5, 0.3, unequal=0.0),)
    shares = []
    for gear in (GEAR, with_fit(-1e-5)):
        maps = [influence_map(FLEX, gear.wave_generator, gear.gauges, effects) for effects in (eccentric, ())]
        change = np.abs(maps[0].coefficients - maps[1].coefficients)[0, 1:].max(axis=0)
        shares.append(change[2] / change[0])
    assert shares[0] < 1e-6
    assert shares[1] > 0.05


def test_the_truss_itself_is_pressed_outwards_only() -> None:
    """By the stiffness matrix of the whole truss, the band is nowhere pulled, and free of force where it lifts off."""
    gear, psi = with_fit(0.0), PSI[[0, 37]]
    solver = DirectSolver(FLEX, gear)
    turn = solver._to_cylindrical()
    matrix = turn @ FLEX.sector.truss().matrix @ turn.T
    asked, forces = (field[[0, 37]] for field in asked_and_forces(gear, LOAD))
    displacement = SECTORS * np.fft.irfft(pressed(FLEX, EXACT_STRUCTURE, asked, forces, psi), SECTORS, axis=1)
    of_teeth = SECTORS * np.fft.irfft(forces, SECTORS, axis=1)
    for moved, force in zip(displacement, of_teeth, strict=True):
        given = np.zeros((SECTORS, 3 * len(FLEX.sector.nodes)))
        given[:, solver.touching] = moved[:, None]
        loads = (force[:, None] * solver.unit_force).ravel()
        reaction = matrix @ solver.factorised.solve(loads, given.ravel()) - loads
        on_band = reaction.reshape(SECTORS, -1)[:, solver.touching].sum(axis=1)
        assert on_band.max() > 20  # N
        assert on_band.min() > -0.02 * on_band.max()
        assert 0.3 < (on_band < 0.02 * on_band.max()).mean() < 0.5


def test_a_softer_sleeve_that_touches_nothing_is_displaced_further_by_the_teeth() -> None:
    asked, forces = asked_and_forces(with_fit(0.0), LOAD)
    asked[:, 0] -= 1.0
    softer = StructureFactors(compliance=(np.log(1.5),) * WAVES)
    usual, soft = (pressed(FLEX, factors, asked, forces, PSI)[:, :WAVES] for factors in (EXACT_STRUCTURE, softer))
    np.testing.assert_allclose(soft, 1.5 * usual)
    with pytest.raises(ValueError, match="compliance"):
        StructureFactors(compliance=(0.0,) * (2 * WAVES))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"presses_only": True, "interference": 1e-3}, "interference of the wave generator"),
        ({"interference": 1e-5}, "set presses_only to true"),
    ],
)
def test_a_wave_generator_that_cannot_be_is_refused(given: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        WaveGenerator(**given)
