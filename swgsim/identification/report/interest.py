"""Whether a change is large enough to matter, compared with the spread of healthy units of a series."""

import numpy as np

from swgsim.dataset.faults import FAULTS
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import signature
from swgsim.identification.fit.map_fit import linearised
from swgsim.identification.fit.priors import of_bench, of_unit

# A significant change below this share is reported, but is no verdict. A fifth of the standard deviation between units
# is within what a maker delivers as healthy (an estimate).
INTEREST = 0.2


def shares_of_spread(fitted: Fitted) -> list[float]:
    """Largest change of an order line by each added effect, in standard deviations of that line.

    The standard deviation is that of a single recording of any healthy unit of the series on the same bench: by the
    declared parameters of units, by noise and by the errors of single recordings. The five faults always matter, as
    they grow: their share is infinite.
    """
    measured, unit = fitted.measured, fitted.unit
    numbers = fitted.numbers_added
    if not numbers:
        return []
    gear = unit.nominal or unit.model.gear
    bench = of_bench(gear)
    series = {name: each for name, each in of_unit(gear).items() if name not in bench}
    _, J = linearised(unit.model, series, measured.situations, measured.layout)
    alone = fitted.errors.alone
    variance = (measured.rows(J) ** 2).sum(axis=1) + alone.variance.ravel() + (alone.C**2).sum(axis=-1).ravel()
    faults = [type(fitted.model.effects[number]).name() in FAULTS for number in numbers]
    changes = [np.abs(signature(fitted, number) / np.sqrt(variance)).max() for number in numbers]
    return np.where(faults, np.inf, changes).tolist()
