"""The loop on recordings of a bench that shares no code with the model, and the physics of that bench itself."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from chain_fixtures import GEAR
from other_bench import schedule
from other_bench.bench import record
from other_bench.circle import STEP
from other_bench.effects import Drawn, Effect
from other_bench.engagement import TORQUES, tooth_forces, wave_generator
from other_bench.frustum import places
from other_bench.gauges import maps_of
from other_bench.hat import Hat
from other_bench.motion import RATE, Drive, moved
from other_bench.schedule import Run, session
from other_bench.shell import ACROSS_GRID, solved
from other_bench.specimen import Crack, Specimen, draw

from swgsim.effects.base import Effect as Found
from swgsim.effects.library import LIBRARY
from swgsim.identification.commissioning.commissioning import learn_unit
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.decide.decision import decide
from swgsim.identification.fit.unit import STRUCTURE, Unit
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_search import search
from swgsim.identification.report.interest import INTEREST, shares_of_spread
from swgsim.recordings.read import read_recordings

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
SPECIMEN = "first"
RATIO = 101
SEARCHED = [LIBRARY[name] for name in ("eccentric_wave_generator", "reduced_damping", "tilting_moment", "gauge_gain")]
DRAWN = Drawn(theta=2.0, phase=1.0, channel=3)


def recorded(out: Path, seed: int, effect: Effect) -> None:
    """Two recordings of each set point, without the middle load, to save time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(schedule, "LOADS", (7.0, 70.0))
        patch.setattr(schedule, "REPEATS", 2)
        record(out, seed, effect, SPECIMEN)


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two sessions of a healthy unit."""
    out = tmp_path_factory.mktemp("healthy")
    recorded(out, 1, Effect("none", 0.0, DRAWN))
    return out


@pytest.fixture(scope="module")
def unit(healthy: Path) -> Unit:
    """That unit as commissioned on the first of them."""
    return learn_unit(Measured.of(read_recordings(healthy / "commissioning")), Unit(Model(GEAR)))


def found(folder: Path, unit: Unit) -> list[Found]:
    """All effects that are large enough to matter."""
    decision = decide(Measured.of(read_recordings(folder)), unit, SEARCHED)
    shares = zip(decision.effects, shares_of_spread(decision.after), strict=False)  # those of regularities follow
    return [effect for effect, share in shares if share >= INTEREST]


def ideal(**changes: object) -> Specimen:
    """A unit whose gauges sit where they should."""
    nothing = {"position": np.zeros(4), "arms": np.zeros(4), "grid_angle": np.zeros(5)}
    return replace(draw(SPECIMEN), **nothing, **changes)


def runs_of(**changes: object) -> list[Run]:
    """Recordings to be made of a unit, one of each set point."""
    runs = session(replace(draw(SPECIMEN), **changes), "some", np.random.default_rng(3))[:6]
    return sorted(runs, key=lambda run: (run.n, run.T))


def test_a_healthy_gear_of_other_code_is_commissioned_as_accurately_as_it_can_be(unit, healthy):
    assert unit.structure > STRUCTURE
    assert found(healthy / "recordings", unit) == []


def test_what_single_recordings_of_other_code_hold_between_the_orders_is_no_line(healthy):
    """A channel is quieter between its lines than its converter rounds: no noise, and nothing stands out of it."""
    once = [each for each in read_recordings(healthy / "recordings") if each.repeat == 1]
    found = search(gauge_spectra(once), LIBRARY.values(), 0.005)
    assert found.named == found.unnamed == ()


def test_an_eccentric_wave_generator_of_other_code_is_found_alone(unit, tmp_path):
    recorded(tmp_path, 2, Effect("eccentric_wave_generator", 15e-6, DRAWN))
    (eccentric,) = found(tmp_path / "recordings", unit)
    assert eccentric.name() == "eccentric_wave_generator"
    assert eccentric.theta == pytest.approx(DRAWN.theta, abs=0.1)
    # Its size only roughly: a truss and a shell give way differently.
    assert eccentric.r == pytest.approx(15e-6, rel=0.5)


def test_rigid_motions_strain_no_frustum():
    """Along the axis, across it, and a tilt: uz, ur, v and slope of two nodes."""
    z, r = np.array([-3e-3, -1e-3]), np.array([20e-3, 23e-3])
    dz, dr = np.diff(z) / np.hypot(np.diff(z), np.diff(r)), np.diff(r) / np.hypot(np.diff(z), np.diff(r))
    at = places(z, r, np.zeros(3, int), np.array([0.1, 0.5, 0.8]))
    along = np.tile([1, 0, 0, 0], 2)
    across = np.tile([0, 1, 1j, 0], 2)
    tilt = np.ravel([[-r[i], z[i], 1j * z[i], dr[0] ** 2 + dz[0] ** 2] for i in (0, 1)])
    assert at.strains(0) @ along == pytest.approx(0, abs=1e-12)
    assert at.strains(1) @ across == pytest.approx(0, abs=1e-9)
    assert at.strains(1) @ tilt == pytest.approx(0, abs=1e-9)


def test_the_collar_carries_a_torque_as_statics_say():
    """Shear flow T / (2 pi r^2), averaged over the grid, over G t."""
    hat = Hat()
    G = hat.E / 2 / (1 + hat.nu)
    radii = hat.gauge_radius + hat.grid * ACROSS_GRID
    shear = solved(hat).C["shear", "tangential"][0]
    # Of 1 N/rad around the circumference.
    assert shear == pytest.approx(-hat.R / (G * hat.collar) * np.mean(1 / radii**2), rel=5e-3)


def test_teeth_carry_the_whole_torque_cracked_or_not():
    for tip in (Crack(), Crack(0.8, 1.0)):
        gear = ideal(tip=tip)
        q = tooth_forces(gear, wave_generator(gear))[1]
        assert -q.sum(axis=-1) * STEP * gear.hat.R == pytest.approx(np.broadcast_to(TORQUES, q.shape[:2]))


def test_gauges_of_an_ideal_unit_are_symmetric():
    own = maps_of(ideal()).own
    assert own[1] == pytest.approx(own[3], abs=1e-9)
    assert own[2] == pytest.approx(own[4], abs=1e-9)
    # A quarter of a turn on, the lobes are half a period on.
    turned = np.exp(-0.5j * np.pi * np.arange(own.shape[-1]))
    assert own[2] == pytest.approx(own[1] * turned, abs=1e-9)
    assert abs(own[..., 1::2]).max() < 1e-9
    ripple = abs(own[1, 0, 1:])
    assert ripple.argmax() + 1 == 2
    assert ripple[1] > 10 * np.delete(ripple, 1).max()


@pytest.mark.parametrize("kind", ["root", "tip"])
def test_a_crack_a_quarter_further_on_shows_in_the_next_gauge(kind):
    here, next_ = (maps_of(ideal(**{kind: Crack(0.9, angle)})).own for angle in (0.4, 0.4 + np.pi / 2))
    turned = np.exp(-0.5j * np.pi * np.arange(here.shape[-1]))
    assert next_[[2, 3, 4, 1]] == pytest.approx(here[[1, 2, 3, 4]] * turned, abs=1e-9)
    assert abs(here[1] - here[3]).max() > 1e-5


def test_a_gear_without_friction_is_a_spring():
    """Both torques are slopes of one elastic energy: T_wg changes with c as -T_out does with phi."""
    drive = Drive(runs_of(b0=0.0, b1=0.0, b3=0.0, mu=0.0))
    y = drive.start(np.linspace(0, 3, 6), np.full(6, 39.0))
    step = 1e-5

    def slopes(row: int, torque: int) -> np.ndarray:
        moved = np.zeros_like(y)
        moved[row] = step
        return (drive.torques(y + moved)[torque] - drive.torques(y - moved)[torque]) / (2 * step)

    assert slopes(2, 1) == pytest.approx(-slopes(0, 2), rel=1e-6)


def test_without_friction_no_work_is_lost():
    for motion in moved(runs_of(b0=0.0, b1=0.0, b3=0.0, mu=0.0)):
        assert RATIO * motion.T_in.mean() == pytest.approx(motion.T_out.mean(), rel=5e-3)


def test_friction_takes_its_share():
    efficiency = np.array([m.T_out.mean() / (RATIO * m.T_in.mean()) for m in moved(runs_of())]).reshape(2, 3)
    assert (efficiency < 0.95).all()
    assert (efficiency > 0.3).all()
    assert (np.diff(efficiency, axis=1) > 0).all(), "the more load, the less of it is lost"
    assert (np.diff(efficiency, axis=0) < 0).all(), "the faster, the more is lost"


def test_the_gear_keeps_speed_load_and_ratio():
    runs = runs_of()
    for run, motion in zip(runs, moved(runs), strict=True):
        assert motion.omega.mean() * 30 / np.pi == pytest.approx(run.speed, rel=1e-3)
        assert motion.T_out.mean() == pytest.approx(run.load, rel=0.02)
        assert np.ptp(motion.phi) == pytest.approx(RATIO * np.ptp(motion.turned), rel=1e-3)
        assert np.ptp(motion.phi) == pytest.approx(np.trapezoid(motion.omega) / RATE, rel=1e-6)
