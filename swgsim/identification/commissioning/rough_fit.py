"""A first fit to a gear that may be far off the nominal one, and the narrow bands of noise that its repeats show."""

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Bool

from swgsim.identification.covariance.narrow_band import NarrowBand, frequencies, narrow_bands
from swgsim.identification.data.features import ORDERS
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.repeated import freedom
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import SAME_SCATTER, fit
from swgsim.identification.fit.unit import Unit

# Variance of a line about the model, relative to that of the noise, at first. With the noise alone, a fit that begins
# far off leaves the gears that exist.
ROUGH = 1e4
# So often at most the narrow bands are estimated again, until the errors of single recordings are the same.
MOST_ROUNDS = 6


def roughly_fitted(
    measured: Measured,
    unit: Unit,
    lines: Bool[np.ndarray, " feature"],
    position: Mapping[str, float] | None = None,
    held: Collection[str] = (),
) -> Fitted:
    """Fit parameters, and estimate the narrow bands of noise from the repeats, in turns.

    Repeats differ by errors of single recordings, and the model must know how these change the lines. What it does not
    know is noise. What all repeats have in common is no noise, but a matter of the model.

    Parameters
    ----------
    measured : Measured
    unit : Unit
    lines : array (feature,)
        The features that may lie far off at first.
    position, held
        As of :func:`~swgsim.identification.fit.fitting.fit`.
    """
    if not measured.spare:
        return fit(measured, unit, position=position, held=held)
    known = unit.inflated(np.ones(len(lines)))
    rough = replace(unit, inflation=np.where(lines, ROUGH * known, known))
    fitted = fit(measured, rough, position=position, held=held)
    for _ in range(MOST_ROUNDS):
        position = {**(position or {}), **fitted.calibrated.position}
        before = fitted.errors.alone
        fitted = fit(measured, replace(unit, bands=_between_repeats(fitted, unit)), position=position, held=held)
        if before.divergence(fitted.errors.alone) < SAME_SCATTER * fitted.calibrated.lack_of_fit:
            break
    return fitted


def _between_repeats(fitted: Fitted, unit: Unit) -> tuple[NarrowBand, ...]:
    """Narrow bands by what repeats differ by, without the estimates of their other errors; a line is as certain as the
    unit has it.
    """
    measured, kinds = fitted.measured, len(fitted.scatter.sd)
    alone = replace(fitted.errors.alone, variance=unit.inflated(measured.variance))
    residual = measured.about_repeats(fitted.residual.reshape(measured.values.shape))
    C = alone.C[..., :kinds]
    others = C.swapaxes(1, 2) @ alone.weigh(residual.ravel()).reshape(*residual.shape, 1)
    missed = (residual - (C @ others)[..., 0]) / np.sqrt(measured.variance)
    layout, points = measured.layout, [each.point for each in measured.recordings]
    lines = layout.lines(missed)[..., 1:]
    return narrow_bands(lines, frequencies(points, 1, ORDERS), freedom(measured.repeats), layout.channels)
