"""The beat: what turns with the circular spline drifts against the recorded angle."""

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import POINTS, recorded, silent, turning

from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import BEATS, Scatter, of_beats, of_recordings
from swgsim.identification.data.beat import BEATING, behind, drifting
from swgsim.identification.data.features import Layout, features
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, predict
from swgsim.identification.fit.map_fit import calibrate
from swgsim.identification.fit.priors import at, of_unit
from swgsim.identification.interharmonics.signal_shapes import ordinary, scene_of

LAYOUT = Layout(("T_out",))
N = 100


@pytest.mark.parametrize("number", range(len(BEATING)))
def test_features_of_a_drifting_wave_follow_from_those_of_still_ones(number):
    order, phi = BEATING[number], turning(POINTS[0], 12.2, 10_000.0)
    (drift,) = drifting([recorded({"phi_in": phi})], N)
    # Here a kinematic error makes a torque twice as large.
    cosine, sine = (2 * LAYOUT.vector(np.eye(1, 13, order)[None] * part)[0] for part in (1.0 + 0j, -1j))
    angle = (order - behind(order, N)) * phi + behind(order, N) * phi.mean()
    for phase, part in ((0.0, np.real), (np.pi / 2, np.imag)):
        seen = features(recorded({"phi_in": phi, "T_out": 2 * np.cos(angle + phase)}), LAYOUT)
        np.testing.assert_allclose(part(drift[number] @ (cosine - 1j * sine)), seen, atol=1e-9)


@pytest.mark.parametrize("order", [0.02, 0.99, 1.98, 3.96, 3.98, 5.96, 7.92, 7.96])
def test_the_beat_its_products_and_its_square_are_made_of_few_orders(order):
    phi = turning(POINTS[0], 12.2, 10_000.0)
    orders = ordinary(scene_of(recorded({"phi_in": phi})), N)
    wave = np.cos(order * phi + 1)
    left = wave - orders @ np.linalg.lstsq(orders, wave)[0]
    assert np.abs(left).max() < 0.02


def test_a_planned_recording_has_no_drift():
    (drift,) = drifting([recorded({"phi_in": np.zeros(2)})], N)
    np.testing.assert_array_equal(drift, np.tile(np.eye(25), (3, 1, 1)))


def test_a_beat_tells_the_drive():
    """Its phase is another one in every recording; how speed and torque answer it is always the same."""
    model = Model(GEAR.with_transmission(kinematic_error=()))
    parameters = {"J_in": of_unit(model.gear)["J_in"]}
    heavier = at(model, parameters, {"J_in": 0.3})
    layout, recordings = Layout(("n_in", "T_out")), silent(POINTS[:2], repeats=2)
    nothing = np.zeros((len(recordings), len(layout)))
    measured = Measured(recordings, layout, nothing, nothing)
    beats = 5e-5 * np.random.default_rng(1).normal(size=(len(recordings), len(BEATS)))
    (steady,) = predict([heavier], measured.situations, layout)
    values = steady[measured.of_recording] + of_beats([heavier], measured, beats)[0]

    scatter = Scatter({**Scatter.stated(layout).sd, **dict.fromkeys(BEATS, 5e-5)}, 0, np.eye(1))
    single = scatter.columns(of_recordings(model, measured))
    errors = Covariance(RecordingCovariance(nothing + 1e-4, single), np.zeros((nothing.size, 0)))
    (still,) = predict([model], measured.situations, layout)
    found = scatter.beats(errors.single_mean((values - still[measured.of_recording]).ravel()))
    np.testing.assert_allclose(found, beats, atol=1e-5)

    def learned(**more) -> float:
        of_recording = measured.of_recording
        fitted = calibrate(model, parameters, values, errors, measured.situations, of_recording, layout, **more)
        return fitted.position["J_in"]

    assert learned() < 0.1
    assert learned(beat=lambda models: of_beats(models, measured, found)) == pytest.approx(0.3, abs=0.05)
