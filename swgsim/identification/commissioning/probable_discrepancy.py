"""The most probable model discrepancy of a healthy gear, among some standard deviations of it."""

import numpy as np

from swgsim.identification.commissioning.relinearisation import about_its_lines, again
from swgsim.identification.covariance.model_discrepancy import Shares, discrepancies
from swgsim.identification.fit.fitted import Fitted
from swgsim.storage.labelled_signals import SENSORS

# Standard deviations of the complex factor on each line of speed and torques that are tried.
DISCREPANCIES = (0.001, 0.003, 0.01, 0.03)
# Below so many standard deviations of the noise, the discrepancy of a line is not seen, and left out.
LEAST_SEEN = 0.1


def with_probable_discrepancy(fitted: Fitted) -> Fitted:
    """The fit with the discrepancy that makes the recordings most probable; the same fit if that is none."""
    measured, layout = fitted.measured, fitted.measured.layout
    points = list(dict.fromkeys(recording.point for recording in measured.recordings))
    best: Shares | None = None
    most = fitted.log_likelihood
    for shares in (_seen(fitted, sd) for sd in DISCREPANCIES):
        of_situations = discrepancies(shares, points, measured.situations, fitted.calibrated.predicted, layout)
        log_likelihood = fitted.whole.with_columns(measured.rows(of_situations)).log_likelihood(fitted.from_start)
        if log_likelihood > most:
            best, most = shares, log_likelihood
    if best is None:
        return fitted
    # The last part of the shift is that of lines; what is new comes before it.
    new = np.zeros(2 * np.count_nonzero(best))
    shift = None if fitted.unit.shift is None else np.append(new, fitted.unit.shift)
    found = about_its_lines(again(fitted, discrepancy=best, healthy=measured.recordings, shift=shift))
    return found if found.log_likelihood > fitted.log_likelihood else fitted


def _seen(fitted: Fitted, sd: float) -> Shares:
    """The discrepancies that are seen, if each has this standard deviation."""
    measured, layout = fitted.measured, fitted.measured.layout
    points = np.array(measured.point_rows())[:, :: len(layout)]
    power = np.abs(layout.lines(fitted.calibrated.predicted)[measured.of_recording]) ** 2
    at_points = np.sqrt([power[rows].mean(axis=0) for rows in points])
    noise = np.sqrt(layout.lines(measured.variance).real.mean(axis=0))
    seen = sd * at_points > LEAST_SEEN * noise
    seen[:, :, 0] = False  # means follow load and friction
    seen[:, np.isin(layout.channels, SENSORS)] = False
    return sd * seen
