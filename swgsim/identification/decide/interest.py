"""Whether a change is large enough to matter: compared with what distinguishes two units of a series."""

import numpy as np

from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import signature
from swgsim.identification.fit.map_fit import linearised
from swgsim.identification.fit.priors import of_unit

# A significant change below this distance is reported, but is no verdict. Half a standard deviation of what
# distinguishes two units of a series is within what a maker delivers as healthy (an estimate).
INTEREST = 0.5


def unit_distances(fitted: Fitted) -> list[float]:
    """Distance that each added effect moves the recordings, in standard deviations of units of a series and of errors.

    It is the Mahalanobis distance with the covariance of the errors and of the declared parameters over units. A lot of
    friction may be as close to a healthy gear as a little ripple at an order that no healthy gear shows.
    """
    measured, unit = fitted.measured, fitted.unit
    numbers = range(len(unit.model.effects), len(fitted.model.effects))
    if not numbers:
        return []
    series = of_unit(unit.nominal or unit.model.gear)
    _, J = linearised(unit.model, series, measured.situations, measured.layout)
    between_units = fitted.errors.with_columns(measured.rows(J))
    changes = np.stack([signature(fitted, number) for number in numbers], axis=1)
    return np.linalg.norm(between_units.whiten(changes), axis=0).tolist()
