"""The most probable model discrepancy of a healthy gear."""

import numpy as np
from jaxtyping import Float

from swgsim.identification.commissioning.relinearisation import about_its_lines, again
from swgsim.identification.covariance.model_discrepancy import Discrepancy
from swgsim.identification.fit.fitted import Fitted
from swgsim.storage.labelled_signals import SENSORS

# Standard deviations that are tried beside none, first for all lines of speed and torques, then for those of gauges.
# That there is none is as probable as that there is any of them.
DISCREPANCIES = (0.001, 0.003, 0.01, 0.03)
# Below so many standard deviations of the noise, the discrepancy of a line is not seen.
LEAST_SEEN = 0.1


def with_probable_discrepancy(fitted: Fitted) -> Fitted:
    """The fit with the discrepancy that makes the recordings most probable; the same fit if that is none."""
    found = probable(fitted)
    if not found.sd.any():
        return fitted
    # The last part of the shift is that of lines; what is new comes before it.
    new = np.zeros(2 * np.count_nonzero(found.determined))
    shift = None if fitted.unit.shift is None else np.append(new, fitted.unit.shift)
    again_fitted = about_its_lines(again(fitted, discrepancy=found, shift=shift))
    return again_fitted if again_fitted.log_likelihood > fitted.log_likelihood else fitted


def probable(fitted: Fitted) -> Discrepancy:
    """The most probable discrepancy, by the linearised model."""
    layout = fitted.measured.layout
    gauges = np.isin(layout.channels, SENSORS)
    best = _discrepancy(fitted, np.zeros(len(gauges)))
    prior = np.log([0.5, *[0.5 / len(DISCREPANCIES)] * len(DISCREPANCIES)])
    for channels in (~gauges, gauges):
        tried = [best, *(_discrepancy(fitted, np.where(channels, sd, best.sd)) for sd in DISCREPANCIES)]
        best = tried[int(np.argmax(prior + [_log_likelihood(fitted, each) for each in tried]))]
    return best


def _log_likelihood(fitted: Fitted, discrepancy: Discrepancy) -> float:
    columns = discrepancy.columns(fitted.measured.situations, fitted.calibrated.predicted, fitted.measured.layout)
    return fitted.whole.with_columns(fitted.measured.rows(columns)).log_likelihood(fitted.from_start)


def _discrepancy(fitted: Fitted, sd: Float[np.ndarray, " channel"]) -> Discrepancy:
    """The discrepancy with a standard deviation in each channel, for all lines but means: these follow load, friction
    and zeros.
    """
    measured, layout = fitted.measured, fitted.measured.layout
    noise = np.sqrt(layout.lines(fitted.unit.inflated(measured.variance)).real.mean(axis=0))
    least = np.full(noise.shape, np.finfo(float).max)
    np.divide(LEAST_SEEN * noise, sd[:, None], out=least, where=sd[:, None] > 0)
    least[:, 0] = np.finfo(float).max
    points = tuple(dict.fromkeys(each.point for each in measured.recordings))
    lines = np.abs(layout.lines(fitted.calibrated.predicted))
    at_points = [lines[[each.point == point for each in measured.situations]].max(axis=0) for point in points]
    return Discrepancy(sd, least, points, np.array(at_points) > least)
