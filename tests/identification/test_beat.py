"""The beat: what turns with the circular spline drifts against the recorded angle."""

import numpy as np
import pytest
from loop_fixtures import POINTS, recorded, turning

from swgsim.identification.data.beat import BEATING, beat_orders, behind, drifting
from swgsim.identification.data.features import Layout, features

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


def test_orders_of_the_beat():
    found = beat_orders(N)
    for order in (0.02, 0.99, 1.98, 3.96, 3.98, 5.96):
        assert min(abs(each - order) for each in found) < 1e-3


def test_a_planned_recording_has_no_drift():
    (drift,) = drifting([recorded({"phi_in": np.zeros(2)})], N)
    np.testing.assert_array_equal(drift, np.tile(np.eye(25), (len(BEATING), 1, 1)))
