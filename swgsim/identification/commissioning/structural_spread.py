"""Structural spread: the probable deviation of a healthy gear's structure from the truss, and of its gauges.

Both are standard deviations of priors, and the recordings of the healthy gear tell which are the most probable: with a
smaller spread they are unlikely, and with a larger one they would be likelier to look different.
"""

from collections.abc import Collection, Mapping
from dataclasses import replace
from itertools import product

import numpy as np

from swgsim.identification.commissioning.rough_fit import roughly_fitted
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit

# Spreads of the factors that are tried: 0.01 is the mesh of the truss, and 0.5 the truss of another author.
SPREADS = (0.01, 0.03, 0.1, 0.3, 0.5)
# Spreads of the gauges that are tried, relative to those of a series.
OF_GAUGES = (1.0, 3.0, 10.0)
# With this one and the last of the gauges all waves are free, so that the linearised model serves all others.
WIDEST_SPREAD = 0.5


def with_probable_spreads(
    measured: Measured, unit: Unit, position: Mapping[str, float], held: Collection[str]
) -> Fitted:
    """The fit with the most probable spreads of structure and gauges.

    Parameters
    ----------
    measured : Measured
        Of the healthy gear.
    unit : Unit
    position : mapping
        Where parameters begin, in spreads.
    held : collection of str
        Parameters that stay there.
    """
    widest = replace(unit, structure=WIDEST_SPREAD, of_gauges=OF_GAUGES[-1])
    ripple = measured.layout.of_gauges & (measured.layout.order > 0)
    wide = roughly_fitted(measured, widest, ripple, position, held)
    found = most_probable(wide)
    ratios = _ratios(wide, found)
    narrow = {name: by / ratios[name] for name, by in wide.calibrated.position.items()}
    return fit(measured, found, position={**position, **narrow}, held=held)


def most_probable(wide: Fitted) -> Unit:
    """The unit of a fit with the most probable spreads."""
    units = [replace(wide.unit, structure=s, of_gauges=g) for s, g in product(SPREADS, OF_GAUGES)]
    return max(units, key=lambda each: _evidence(wide, each))


def _evidence(fitted: Fitted, unit: Unit) -> float:
    """Log-likelihood of the recordings with the spreads of a unit, by the linearised model."""
    ratios = np.array(list(_ratios(fitted, unit).values()))
    return fitted.of_nuisances.with_columns(fitted.J * ratios).log_likelihood(fitted.from_start)


def _ratios(fitted: Fitted, unit: Unit) -> dict[str, float]:
    """Spread of each fitted parameter in a unit, relative to the fitted one."""
    declared = unit.declared
    # Parameters of declared effects keep their spread.
    return {name: declared.get(name, p).sd / p.sd for name, p in fitted.parameters.items()}
