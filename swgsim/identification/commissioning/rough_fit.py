"""A first fit to a gear that may be far off the nominal one: each line has the variance that its repeats show."""

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.stats import chi2, false_discovery_control

from swgsim.identification.commissioning.lack_of_fit import FALSE_DISCOVERIES
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit

# Variance of a line about the model, relative to that of the noise, at first. With the noise alone, a fit that begins
# far off leaves the gears that exist.
ROUGH = 1e4
# So often at most the variances are estimated again, until none changes by more than this factor.
MOST_ROUNDS, SETTLED_FACTOR = 6, 1.5


def roughly_fitted(
    measured: Measured,
    unit: Unit,
    lines: Bool[np.ndarray, " feature"],
    position: Mapping[str, float] | None = None,
    held: Collection[str] = (),
) -> Fitted:
    """Fit parameters, and the variance of some lines between repeats, in turns.

    Repeats differ by errors of single recordings, and the model must know how these change the lines. Where it does
    not, their variance counts as noise. What all repeats have in common is no matter of variance, but of the model.

    Parameters
    ----------
    measured : Measured
    unit : Unit
    lines : array (feature,)
        The features whose variance is estimated, one for each line of a channel.
    position, held
        As of :func:`~swgsim.identification.fit.fitting.fit`.
    """
    if not measured.spare:
        return fit(measured, unit, position=position, held=held)
    known = unit.inflated(np.ones(len(lines)))
    inflation = np.where(lines, ROUGH * known, known)
    fitted = fit(measured, replace(unit, inflation=inflation), position=position, held=held)
    for _ in range(MOST_ROUNDS):
        before, inflation = inflation, np.where(lines, _between_repeats(fitted, inflation, known), known)
        if np.abs(np.log(inflation / before)).max() < np.log(SETTLED_FACTOR):
            break
        position = {**(position or {}), **fitted.calibrated.position}
        fitted = fit(measured, replace(unit, inflation=inflation), position=position, held=held)
    return fitted


def _between_repeats(
    fitted: Fitted, inflation: Float[np.ndarray, " feature"], known: Float[np.ndarray, " feature"]
) -> Float[np.ndarray, " feature"]:
    """Variance between repeats of every line of a channel, for each of its features; what is known where chance alone
    could make it so large.
    """
    measured, layout = fitted.measured, fitted.measured.layout
    square = (measured.about_repeats(fitted.missed) ** 2).sum(axis=0)
    of_line = (layout.channel[:, None] == layout.channel) & (layout.order[:, None] == layout.order)
    freedom = measured.spare * of_line.sum(axis=1)
    shown = inflation * (of_line @ square)
    more = false_discovery_control(chi2.sf(shown / known, freedom)) < FALSE_DISCOVERIES
    return np.where(more, np.maximum(known, shown / freedom), known)
