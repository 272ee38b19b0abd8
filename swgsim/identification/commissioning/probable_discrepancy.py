"""The most probable model discrepancy of a healthy gear."""

import numpy as np
from jaxtyping import Float

from swgsim.identification.commissioning.relinearisation import about_its_lines, again
from swgsim.identification.covariance.model_discrepancy import Discrepancy, seen
from swgsim.identification.fit.fitted import Fitted
from swgsim.storage.labelled_signals import SENSORS

# Standard deviations that are tried, first for all lines of speed and torques, then for those of gauges. The prior
# probability of no discrepancy is one half, and these share the other half.
DISCREPANCIES = (0.001, 0.003, 0.01, 0.03)


def with_probable_discrepancy(fitted: Fitted) -> Fitted:
    """The fit with the most probable discrepancy."""
    found = probable(fitted)
    if not found.sd.any():
        return fitted
    shift = fitted.unit.shift
    if shift is not None:  # the directions of the discrepancy are new, and come first
        shift = np.append(np.zeros(2 * np.count_nonzero(found.determined)), shift)
    refitted = about_its_lines(again(fitted, discrepancy=found, shift=shift))
    return refitted if refitted.log_likelihood > fitted.log_likelihood else fitted


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
    """The discrepancy with a standard deviation in each channel."""
    measured, layout = fitted.measured, fitted.measured.layout
    noise = np.sqrt(layout.lines(fitted.unit.inflated(measured.variance)).real.mean(axis=0))
    points = tuple(dict.fromkeys(each.point for each in measured.recordings))
    lines = layout.lines(fitted.calibrated.predicted)
    return Discrepancy(sd, noise, points, seen(sd, noise, points, measured.situations, lines))
