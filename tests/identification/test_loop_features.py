"""Order lines are those of the signal, whatever the speed ripple and wherever the window ends."""

import numpy as np
import pytest
from loop_fixtures import POINTS, recorded, turning

from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data import features as feature_module
from swgsim.identification.data.features import FITTED, ORDERS, Layout, features, features_alike, layout_of, remainder
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra

LAYOUT = Layout(("T_in", "s1"))


def lines_of(seed: int, orders: int = FITTED) -> np.ndarray:
    """Random lines of two channels; the mean is real."""
    rng = np.random.default_rng(seed)
    lines = rng.normal(size=(2, orders + 1)) + 1j * rng.normal(size=(2, orders + 1))
    lines[:, 0] = lines[:, 0].real
    return lines


def signals(lines: np.ndarray, phi: np.ndarray) -> dict[str, np.ndarray]:
    """The two channels."""
    values = np.real(lines @ np.exp(1j * np.outer(np.arange(lines.shape[1]), phi)))
    return {"phi_in": phi, "T_in": values[0], "s1": values[1]}


@pytest.mark.parametrize("revolutions", [12.0, 5.37, 1.4])
def test_lines_of_a_known_signal_are_found(revolutions):
    lines, phi = lines_of(1), turning(POINTS[0], revolutions, 10_000.0)
    found = LAYOUT.lines(features(recorded(signals(lines, phi)), LAYOUT))
    np.testing.assert_allclose(found, lines[:, : ORDERS + 1], atol=1e-9)


def test_recordings_of_equal_length_are_looked_at_together():
    """Also those of one motion, such as the first, the third and the last of these."""
    slow, fast = (turning(OperatingPoint(n, 7.0), 3.0, 10_000.0)[:450] for n in (2000.0, 4000.0))
    several = [recorded(signals(lines_of(seed), phi)) for seed, phi in enumerate((slow, fast, slow, fast, slow))]
    for one, found in zip(several, features_alike(several, LAYOUT), strict=True):
        np.testing.assert_allclose(found, features(one, LAYOUT), atol=1e-12)


def test_a_drift_within_a_recording_is_no_ripple(monkeypatch):
    """Without the straight line that is fitted along, it leaks into the first orders."""
    lines, phi = lines_of(2), turning(POINTS[0], 10.3, 10_000.0)
    steady = signals(lines, phi)
    ramp = (phi - phi.mean()) / np.ptp(phi)
    drifting = {name: values + 0.003 * ramp * (name != "phi_in") for name, values in steady.items()}
    expected = features(recorded(steady), LAYOUT)
    np.testing.assert_allclose(features(recorded(drifting), LAYOUT), expected, atol=1e-9)
    monkeypatch.setattr(feature_module, "TURNS_FOR_DRIFT", np.inf)
    assert np.abs(features(recorded(drifting), LAYOUT) - expected).max() > 5e-5


def test_lines_and_vectors_are_each_others_inverse():
    lines = np.stack([lines_of(seed, ORDERS) for seed in range(3)])
    vectors = LAYOUT.vector(lines)
    assert vectors.shape == (3, len(LAYOUT))
    np.testing.assert_allclose(LAYOUT.lines(vectors), lines, atol=1e-15)
    np.testing.assert_array_equal(LAYOUT.vector(LAYOUT.lines(vectors)), vectors)


def test_channel_and_order_name_each_feature():
    lines = np.zeros((2, ORDERS + 1), complex)
    lines[1, 5] = 2 - 3j
    touched = np.flatnonzero(LAYOUT.vector(lines))
    assert sorted(LAYOUT.vector(lines)[touched]) == [2, 3]
    assert set(LAYOUT.channel[touched]) == {"s1"}
    assert set(LAYOUT.order[touched]) == {5}


def test_a_shifted_trigger_turns_the_lines():
    lines, phi, shift = lines_of(2), turning(POINTS[0], 6.2, 10_000.0), 0.21
    channels = signals(lines, phi)
    late = LAYOUT.lines(features(recorded(channels | {"phi_in": phi - shift}), LAYOUT))
    expected = lines[:, : ORDERS + 1] * np.exp(1j * shift * np.arange(ORDERS + 1))
    np.testing.assert_allclose(late, expected, atol=1e-9)


def test_what_lies_between_the_orders_remains():
    phi = turning(POINTS[0], 12.0, 10_000.0)
    channels = signals(lines_of(3), phi)
    assert np.abs(remainder(recorded(channels), LAYOUT)).max() < 1e-10
    between = remainder(recorded(channels | {"s1": channels["s1"] + np.cos(0.455 * phi)}), LAYOUT)
    assert np.abs(between[0]).max() < 1e-10
    assert np.sqrt(2) * between[1].std() == pytest.approx(1, abs=0.05)


def test_a_channel_that_one_recording_lacks_is_not_compared():
    phi = turning(POINTS[0], 3.0, 10_000.0)
    full = recorded(signals(lines_of(4), phi))
    short = recorded({"phi_in": phi, "s1": full.channels["s1"]})
    assert layout_of([full, short]).channels == ("s1",)


def test_a_recording_with_too_few_samples_per_revolution_is_refused():
    rate = 32.5 * POINTS[0].n_in_rpm / 60
    phi = turning(POINTS[0], 12.0, rate)
    coarse = recorded(signals(lines_of(5), phi), POINTS[0], rate)
    said = r"recording a: 32\.\d samples per revolution .* at least 33 .*: sample at 11\d\d Hz or more"
    with pytest.raises(ValueError, match=said):
        features(coarse, LAYOUT)
    with pytest.raises(ValueError, match=said):
        gauge_spectra([coarse])


def test_a_recording_with_just_enough_samples_per_revolution_tells_noise_and_lines_between():
    rate = 34 * POINTS[0].n_in_rpm / 60
    phi = turning(POINTS[0], 12.2, rate)
    noisy = np.cos(2 * phi) + 1e-3 * np.random.default_rng(6).standard_normal(len(phi))
    (seen,) = gauge_spectra([recorded({"phi_in": phi, "s1": noisy}, POINTS[0], rate)])
    assert 0.5 < seen.power[:, seen.clear].mean() / 2 < 2
