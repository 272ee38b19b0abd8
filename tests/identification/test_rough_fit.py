"""A first fit takes from repeats the noise that no error of single recordings explains, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from bench_fixtures import GEAR, good

from swgsim.common.seeds import generator
from swgsim.identification.commissioning.rough_fit import roughly_fitted
from swgsim.identification.covariance.narrow_band import columns
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit
from swgsim.storage.labelled_signals import SENSORS

pytestmark = pytest.mark.end_to_end
UNIT = Unit(Model(GEAR), seen_healthy=True)


@pytest.fixture(scope="module")
def measured() -> Measured:
    return Measured.of(good(repeats=3))


def ripple(measured: Measured) -> np.ndarray:
    """That of the gauges: the speed has a slow ripple of its own, which leaks into its lines."""
    return np.isin(measured.layout.channel, SENSORS) & (measured.layout.order > 0)


def varying(measured: Measured, channel: str, order: int, times: float) -> Measured:
    """The same where one line differs between recordings by so many standard deviations of the noise."""
    line = (measured.layout.channel == channel) & (measured.layout.order == order)
    rng = generator("varying line", order)
    by = times * np.sqrt(measured.variance) * rng.standard_normal(measured.values.shape) * line
    return replace(measured, values=measured.values + by)


def test_a_line_that_varies_between_repeats_gets_its_variance_and_no_other_line_does(measured):
    fitted = roughly_fitted(varying(measured, "s2", 7, 30.0), UNIT, ripple(measured))
    points = [each.point for each in measured.recordings]
    added = (columns(fitted.unit.bands, points, measured.layout, measured.variance) ** 2).sum(axis=-1)
    line = (measured.layout.channel == "s2") & (measured.layout.order == 7)
    assert (added / measured.variance)[:, line] == pytest.approx(900, rel=0.6)
    # A few of what other gauges had by chance count as shared with it.
    assert ((added / measured.variance)[:, ~line] < 3).all()


def test_what_all_repeats_have_in_common_is_no_variance(measured):
    line = (measured.layout.channel == "s2") & (measured.layout.order == 7)
    moved = replace(measured, values=measured.values + 30 * np.sqrt(measured.variance.mean(axis=0)) * line)
    assert not roughly_fitted(moved, UNIT, ripple(measured)).unit.bands


def test_without_repeats_it_is_an_ordinary_fit():
    once = Measured.of(good(repeats=1))
    rough, plain = roughly_fitted(once, UNIT, ripple(once)), fit(once, UNIT)
    assert not rough.unit.bands
    assert rough.calibrated.position == plain.calibrated.position
