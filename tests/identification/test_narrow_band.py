"""Noise in narrow bands: the gauges share it, repeats tell it, and it is never less than the smooth noise."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import fitted_to

from swgsim.common.seeds import generator
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance.narrow_band import NarrowBand, columns, frequencies, narrow_bands
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.repeats import from_repeats
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.data.repeated import freedom

LAYOUT = Layout(("T_in", "s1", "s2", "s3", "s4"))
GAUGES = LAYOUT.channels[1:]
# A mode with two waves around the flex spline, as large as three times the smooth noise in each gauge.
MODE = NarrowBand(400.0, GAUGES, 3 * np.array([[1.0], [-1.0], [1.0], [-1.0]]))
POINTS = [OperatingPoint(n, T) for n in (2000.0, 3000.0, 4000.0) for T in (7.0, 39.0)]


def repeated(repeats: int, bands: tuple[NarrowBand, ...], seed: int) -> np.ndarray:
    """Noise of so many repeats at every point, less its mean over them, in standard deviations of the smooth one."""
    rng, points = generator("narrow band", seed), POINTS * repeats
    smooth = np.ones((len(points), len(LAYOUT)))
    errors = RecordingCovariance(smooth, columns(bands, points, LAYOUT, smooth))
    made = errors.made(rng.standard_normal(errors.C.shape[0] * errors.C.shape[2])).reshape(smooth.shape)
    drawn = (made + rng.standard_normal(smooth.shape)).reshape(repeats, len(POINTS), -1)
    return (drawn - drawn.mean(axis=0)).reshape(smooth.shape)


def found(repeats: int, bands: tuple[NarrowBand, ...], seed: int) -> tuple[NarrowBand, ...]:
    lines = LAYOUT.lines(repeated(repeats, bands, seed))[..., 1:]
    return narrow_bands(lines, frequencies(POINTS * repeats, 1, ORDERS), freedom(POINTS * repeats), LAYOUT.channels)


def test_it_lies_at_its_frequency_at_every_speed():
    variance = np.full((3, len(LAYOUT)), 4.0)
    made = columns([MODE], [OperatingPoint(n, 7.0) for n in (2000.0, 4000.0, 4100.0)], LAYOUT, variance)
    for part, rows in enumerate(((12, 6), (24, 18))):  # cosine and sine of order 400 Hz / (n / 60)
        for recording, row in enumerate(rows):
            lines = made[recording].reshape(5, -1, 2)[:, row, part]
            assert lines.tolist() == [0, 6, -6, 6, -6]
    assert np.count_nonzero(made) == 16


@pytest.mark.parametrize("seed", range(3))
def test_the_covariance_of_many_repeats_is_the_true_one(seed):
    (band,) = found(100, (MODE,), seed)
    assert band.frequency == 400
    np.testing.assert_allclose(band.root @ band.root.T, MODE.root @ MODE.root.T, atol=1.5)


def test_smooth_noise_is_taken_for_no_band():
    assert sum(bool(found(3, (), seed)) for seed in range(100)) <= 12  # 5 expected


def test_few_repeats_make_no_pattern_too_certain():
    """With three repeats, another recording lies no further off than its covariance says, not even where it is least
    certain by chance.
    """
    squares = []
    for seed in range(60):
        (band,) = [each for each in found(3, (MODE,), seed) if each.frequency == 400]
        variance = np.eye(4) + band.root @ band.root.T
        true = np.eye(4) + MODE.root @ MODE.root.T
        squares.append(np.trace(np.linalg.solve(variance, true)) / 4)
        assert np.linalg.eigvalsh(variance).min() >= 1 - 1e-9
    assert 0.6 < np.mean(squares) < 1.2


def test_it_passes_for_no_other_error_of_single_recordings():
    """A beat that the gauges show alike stays as stated beside a band that hides it."""
    rng, repeats = generator("beside a band"), 6
    points = POINTS * repeats
    smooth = np.ones((len(points), len(LAYOUT)))
    pattern = MODE.directions(4000.0, LAYOUT)[:, :1] / 3
    stated = Scatter({"beat": 1.0}, 0, 0.1 * np.eye(1))
    bands = columns([MODE], points, LAYOUT, smooth)
    made = (bands @ rng.standard_normal((len(points), bands.shape[-1], 1)))[..., 0] + rng.standard_normal(smooth.shape)
    B, groups = np.tile(pattern, (len(points), 1, 1)), [each for _ in range(repeats) for each in range(len(POINTS))]
    known = from_repeats(made, RecordingCovariance(smooth, bands), B, B[..., :0], groups, stated)
    unknown = from_repeats(made, RecordingCovariance.white(smooth), B, B[..., :0], groups, stated)
    assert unknown.sd["beat"] > 1.4
    assert known.sd["beat"] < 1.2


def test_noise_stays_as_it_is_where_other_errors_are_estimated_again():
    fitted = fitted_to(LAYOUT, generator("scattering"))
    kinds, noise = np.ones((*fitted.measured.values.shape, 1)), 2 * np.ones((*fitted.measured.values.shape, 3))
    alone = RecordingCovariance(fitted.measured.variance, noise).beside(kinds)
    fitted = replace(
        fitted, scatter=Scatter({"load": 1.0}, 0, np.zeros((1, 1))), errors=replace(fitted.errors, base=alone)
    )
    C = fitted.scattering(Scatter({"load": 5.0}, 0, np.zeros((1, 1)))).errors.alone.C
    assert (C[..., 0] == 5).all()
    assert (C[..., 1:] == 2).all()
