"""Order lines of signals whose spectra are known in closed form."""

import numpy as np
import pytest
from fabricated import RATE, recordings

from swgsim.storage.orders import lines_of, order_lines, revolution, whole_revolutions


@pytest.mark.parametrize("speed", [2000.0, 4000.0])
def test_line_of_a_cosine_stands_at_its_order_and_nowhere_else(speed):
    angle = 2 * np.pi * np.arange(600) * speed / 60 / RATE
    signal = 3.0 + 0.5 * np.cos(2 * angle + 0.3) + 0.2 * np.sin(5 * angle)
    expected = [3.0, 0, 0.5 * np.exp(0.3j), 0, 0, -0.2j, 0]
    np.testing.assert_allclose(order_lines(signal[None, None], speed, RATE, 6)[0, 0], expected, atol=1e-14)


def test_lines_equal_the_fast_fourier_transform():
    signals = np.random.default_rng(0).standard_normal((3, 5, 600))
    expected = np.fft.rfft(signals)[:, :, 4:25:4] * 2 / 600  # 4 revolutions: order k is bin 4 k
    np.testing.assert_allclose(order_lines(signals, 4000.0, RATE, 6)[:, :, 1:], expected, atol=1e-14)


@pytest.mark.parametrize(("length", "samples"), [(600, 600), (650, 600), (899, 600), (300, 300)])
def test_window_is_cut_to_whole_revolutions(length, samples):
    assert whole_revolutions(2000.0, RATE, length) == samples


def test_revolution_is_the_synchronous_average_of_the_window():
    rng = np.random.default_rng(1)
    signals = rng.standard_normal((2, 5, 600))  # 4 revolutions of 150 samples
    average = signals.reshape(2, 5, 4, 150).mean(axis=2)
    lines = order_lines(signals, 4000.0, RATE, 74)
    without_highest = average - average @ np.cos(np.pi * np.arange(150))[:, None] * np.cos(np.pi * np.arange(150)) / 150
    np.testing.assert_allclose(revolution(lines, 150), without_highest, atol=1e-12)


def test_revolution_needs_two_points_to_a_period():
    with pytest.raises(ValueError, match="8 points for orders up to 4: more than 8 are needed"):
        revolution(np.zeros((1, 5, 5), dtype=complex), 8)


def test_lines_of_recordings_are_taken_at_the_speed_of_each():
    data = recordings(gears=1)
    lines = lines_of(data, 6)
    healthy = (data.table["label"] == "healthy").to_numpy()
    gain = 1 + 0.03 * np.sin(1 + np.arange(5))
    np.testing.assert_allclose(np.abs(lines[healthy][:, :, 2]), 0.2 * np.tile(gain, (healthy.sum(), 1)), rtol=1e-6)
    assert np.abs(lines[healthy][:, :, [1, 3, 4, 5, 6]]).max() < 1e-7
