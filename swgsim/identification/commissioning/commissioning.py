"""Commissioning: learning a unit from recordings of its healthy state."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from swgsim.chain.steady_state_cache import forget
from swgsim.identification.commissioning.lack_of_fit import foreign_ripple, lack_of_fit, require_own, unexplained
from swgsim.identification.commissioning.probable_discrepancy import with_probable_discrepancy
from swgsim.identification.commissioning.relinearisation import (
    about_its_lines,
    again,
    largest_of,
    lines_found,
    posterior,
    triangular_factor,
)
from swgsim.identification.commissioning.rough_fit import roughly_fitted
from swgsim.identification.commissioning.structural_spread import with_probable_spreads
from swgsim.identification.covariance.influence_map_error import largest_lines
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import UNHEARD, Unit
from swgsim.storage.labelled_signals import SENSORS

# Lines with lack of fit are learned: each gets a prior standard deviation. The first number is the largest one of a
# gauge's line, relative to the largest line of all gauges (in a bridge of many arms, large lines may cancel).
# Lines of speed and torques are learned if at most the second share of their channel's ripple is unexplained. With a
# larger share the ripple does not belong to this gear.
MOST_LEARNED, FOREIGN_SHARE = 0.6, 0.5
# Largest number of fits of the drive until convergence, and number of times that lines of gauges are learned.
DRIVES, TIMES = 4, 2


def learn_unit(measured: Measured, unit: Unit) -> Unit:
    """The posterior of a unit, given recordings of its healthy state.

    Raises
    ------
    ValueError
        If the model does not describe the healthy gear.
    """
    forget()
    fitted = _with_usable_ripple(measured, replace(unit, seen_healthy=True))
    require_own(_with_inflated_variance(fitted), fitted.missed)
    fitted = with_probable_discrepancy(fitted)
    # Directions are the fitted parameters, then those of fitted.open. R R' is their posterior covariance.
    R, mean = posterior(fitted)
    # Declared effects keep their values; later fits have parameters for them.
    own = [name in fitted.unit.declared for name in fitted.parameters]
    kept = np.flatnonzero([*own, *[True] * fitted.open.shape[1]])
    # The rows of R that are kept have more columns than rows. The triangle has the same covariance with fewer columns.
    reach, shift = triangular_factor(R[kept].T).T, mean[kept]
    # Lines become part of the model, so that effects on the signals act on them too. They are the last directions, and
    # relative to the model with them their mean is 0.
    lines, form = lines_found(fitted, mean)
    shift[len(shift) - form :] = 0.0
    model, nominal = replace(fitted.model, own_lines=lines), fitted.unit.model.gear
    return replace(
        fitted.unit, model=model, reach=reach, shift=shift, scatter=fitted.scatter,
        nominal=nominal, largest=largest_of(fitted), healthy=measured.recordings,
    )  # fmt: skip


def _with_usable_ripple(measured: Measured, unit: Unit) -> Fitted:
    """The fit without ripple of speed and torques that the model does not describe: its inflation is UNHEARD."""
    while True:
        drive, foreign = _drive_alone(measured, unit), np.zeros(len(measured.layout), bool)
        if drive is not None:
            foreign[measured.layout.of_drive] = foreign_ripple(
                _with_inflated_variance(drive), drive.missed, FOREIGN_SHARE
            )
        if not foreign.any():
            fitted = _with_learned_lines(measured, unit, drive)
            foreign = foreign_ripple(_with_inflated_variance(fitted), fitted.missed)
        inflation = unit.inflated(np.ones(len(measured.layout)))
        foreign &= inflation < UNHEARD
        if not foreign.any():
            return fitted
        unit = replace(unit, inflation=np.where(foreign, UNHEARD, inflation))


def _with_inflated_variance(fitted: Fitted) -> Measured:
    """The recordings with the variance that the fit has for their lines, narrow bands of noise among it."""
    alone = fitted.errors.alone
    narrow = (alone.C[..., len(fitted.scatter.sd) :] ** 2).sum(axis=-1)
    return replace(fitted.measured, variance=alone.variance + narrow)


def _with_learned_lines(measured: Measured, unit: Unit, drive: Fitted | None) -> Fitted:
    """The fit to recordings of the healthy gear, whatever drive and structure it has.

    Lines of speed and torques are learned from speed and torques only. Lines of the gauges are learned twice, because
    missing lines bias the parameters at first.
    """
    # The fit begins at the parameters that speed and torques gave. Those that they determine well are held at first.
    position: Mapping[str, float] = {}
    held: list[str] = []
    of_drive = np.zeros(len(measured.layout))
    if drive is not None:
        unit = replace(unit, bands=drive.unit.bands)
        position, held = drive.calibrated.position, _well_determined(drive)
        if drive.unit.learned is not None:
            of_drive[measured.layout.of_drive] = drive.unit.learned
    fitted = with_probable_spreads(measured, _given(unit, of_drive), position, held)
    unit = fitted.unit
    for _ in range(TIMES):
        learned = np.where(measured.layout.of_drive, of_drive, _lie_off(fitted))
        position = {**position, **fitted.calibrated.position}
        fitted = fit(measured, _given(unit, learned), position=position)
        if not learned.any():
            break
    return about_its_lines(fitted)


def _given(unit: Unit, learned: Float[np.ndarray, " feature"]) -> Unit:
    """The unit with lines that are learned, given the prior standard deviation of each; 0 for all others."""
    return replace(unit, learned=learned) if learned.any() else unit


def _well_determined(drive: Fitted) -> list[str]:
    """Parameters of the unit that speed and torques determine to less than half a prior standard deviation."""
    if not drive.calibrated.settled:
        return []
    return [name for name, parameter in drive.declared.items() if drive.deviation[name] < parameter.sd / 2]


def _drive_alone(measured: Measured, unit: Unit) -> Fitted | None:
    """The fit to speed and torques only, where lines with lack of fit are learned.

    Gauges on another flex spline would bias the drive, and other equations of motion would bias the gauges. Ripple is
    learned first: as lack of fit it would bias the friction, which the means determine.
    """
    drive_features = measured.layout.of_drive
    if not drive_features.any():
        return None
    drive = tuple(name for name in measured.layout.channels if name not in SENSORS)
    alone = Measured(
        measured.recordings, Layout(drive), measured.values[:, drive_features], measured.variance[:, drive_features]
    )
    # Speed and torques show nothing of the structure.
    inflation = None if unit.inflation is None else unit.inflation[drive_features]
    unit, ripple = replace(unit, structure=0.0, inflation=inflation), alone.layout.order > 0
    fitted = roughly_fitted(alone, unit, ripple)
    for _ in range(DRIVES - 1):
        if fitted.calibrated.settled:
            break
        fitted = again(fitted)
    for sought in (ripple, np.ones_like(ripple)):
        learned = _lie_off(fitted) * sought
        fitted = again(fitted, learned=learned) if learned.any() else fitted
    return fitted


def _lie_off(fitted: Fitted) -> Float[np.ndarray, " feature"]:
    """Prior standard deviation for the lines with lack of fit, now or before: their deviation from the model."""
    measured, layout = fitted.measured, fitted.measured.layout
    sought = lack_of_fit(measured, fitted.missed)
    if fitted.unit.learned is not None:
        sought |= fitted.unit.learned > 0
    off = np.sqrt((fitted.residual.reshape(measured.values.shape) ** 2).mean(axis=0)) * sought
    largest = largest_lines(fitted.calibrated.predicted, layout)
    missed = unexplained(_with_inflated_variance(fitted), fitted.missed)
    for channel in layout.channels:
        own = layout.channel == channel
        if channel in largest:
            off[own] = np.minimum(off[own], MOST_LEARNED * max(largest.values()))
        elif missed[channel] > FOREIGN_SHARE:
            off[own] = 0.0
    return off
