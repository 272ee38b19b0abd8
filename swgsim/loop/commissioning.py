"""A unit as recordings of its healthy state show it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float
from scipy.stats import chi2, false_discovery_control

from swgsim.loop.features import Layout
from swgsim.loop.fitting import MISFIT, Fitted, fit
from swgsim.loop.form import column_counts, largest_lines, lines_of
from swgsim.loop.own_lines import Lines
from swgsim.loop.session import Measured
from swgsim.loop.unit import Unit
from swgsim.recordings import SENSORS
from swgsim.turning import forget

# Share of a channel's ripple that the model may leave unexplained of a healthy gear; with more it is not its own, if a
# line of it is also missed by more than MISFIT: a ripple that is hardly more than noise may well be.
UNEXPLAINED = 0.1
# Accuracies of the structural model that are tried beyond the declared one, as shares of a gauge's largest line, while
# a channel is missed by more than so many times what is declared of it (mean squares).
COARSER, WELL = (0.03, 0.1, 0.3), 1.3
# Of the lines that are said to be missed, the share that may be luck.
LUCK = 0.05
# Lines that are missed are learned. A gauge's may lie off by this share of the largest line of all gauges: in a bridge
# of many arms lines cancel that are large in each. Those of speed and torques, of which the equations of motion make
# the most, are learned while no more than this share of their channel's ripple is missed; else it is none of this gear.
LOOSEST, ALIEN = COARSER[-1], 0.5
# Variance of a ripple that is not the model's, in that of noise: so much that it tells nothing.
UNHEARD = 1e8
# So often at most the drive alone is fitted, until the fit has come to rest.
DRIVES = 4
# So often at most a fit is linearised about the lines that it finds, until its log-likelihood stays within so much.
ABOUT, AT_REST = 6, 1.0


def commission(measured: Measured, unit: Unit) -> Unit:
    """The unit with what recordings of its healthy state say about it.

    Raises
    ------
    ValueError
        If the model does not describe the healthy gear.
    """
    forget()
    healthy = replace(unit, seen_healthy=True)
    fitted = _as_it_is(measured, healthy)
    foreign = _foreign(measured, fitted.missed)
    if foreign.any():
        fitted = _as_it_is(measured, replace(healthy, inflation=np.where(foreign, UNHEARD, 1.0)))
    _require_own(measured, fitted.missed)
    beyond = _beyond(measured, fitted.missed)
    if beyond.max() > 1:
        fitted = _about_its_lines(_again(fitted, inflation=beyond * np.where(foreign, UNHEARD, 1.0)))
    covariance, mean = _told(fitted)
    # Declared effects stay as they were found: later fits have parameters of their own for them.
    own = [name in fitted.unit.declared for name in fitted.parameters]
    kept = np.flatnonzero([*own, *[True] * fitted.open.shape[1]])
    reach, shift = np.linalg.cholesky(covariance[np.ix_(kept, kept)]), mean[kept]
    # Lines go into the model, so that effects on the signals act on them too.
    lines, form = _lines(fitted, mean)
    shift[len(shift) - form :] = 0.0
    model, nominal = replace(fitted.model, own_lines=lines), fitted.unit.model.gear
    largest = _largest(fitted)
    return replace(
        fitted.unit, model=model, reach=reach, shift=shift, scatter=fitted.scatter, nominal=nominal, largest=largest
    )


def _about_its_lines(fitted: Fitted) -> Fitted:
    """The fit linearised about the lines that it finds, where the model has them quite different.

    Trigger, gains, lags and temperatures act on the whole of a line, of which the model may have a small part.
    """
    if not (fitted.unit.of_another_structure or fitted.unit.learned is not None):
        return fitted
    largest = _largest(fitted)
    for _ in range(ABOUT):
        _, mean = _told(fitted)
        lines, form = _lines(fitted, mean)
        # What the lines are declared to be is still counted from the model alone.
        back = np.append(np.zeros(fitted.open.shape[1] - form), -mean[len(mean) - form :])
        model = replace(fitted.unit.model, own_lines=lines)
        before, fitted = fitted, _again(fitted, model=model, shift=back, largest=largest)
        if abs(fitted.log_likelihood - before.log_likelihood) < AT_REST:
            break
    return fitted


def _told(fitted: Fitted) -> tuple[Float[np.ndarray, "direction direction"], Float[np.ndarray, " direction"]]:
    """What recordings tell of the parameters, and of all else that is open: its covariance and mean, in spreads."""
    columns = np.hstack([fitted.J, fitted.open])
    white = fitted.errors.whiten(columns)
    covariance = np.linalg.inv(white.T @ white + np.eye(columns.shape[1]))
    mean = covariance @ (white.T @ fitted.errors.whiten(fitted.from_start[:, None])[:, 0])
    # The parameters themselves stay where the fit has them; all else takes up the rest.
    mean[: fitted.J.shape[1]] -= np.array(list(fitted.calibrated.position.values()))
    return covariance, mean


def _lines(fitted: Fitted, mean: Float[np.ndarray, " direction"]) -> tuple[Lines, int]:
    """The lines by which the gear differs from the model, and how many of the directions, the last ones, they are."""
    unit, layout = fitted.unit, fitted.measured.layout
    sizes = unit.form(fitted.calibrated.predicted, layout)
    form = sum(column_counts(sizes, unit.powers))
    gauges = fitted.model.run(fitted.measured.situations[0]).affected_gear.gauges
    before, found = fitted.model.own_lines, mean[len(mean) - form :]
    if before is None or unit.shift is None:
        return lines_of(sizes, found, unit.powers, layout, gauges), form
    more = lines_of(sizes, found + unit.shift[len(unit.shift) - form :], unit.powers, layout, gauges)
    return before.seen_by(gauges).plus(more), form


def _largest(fitted: Fitted) -> Mapping[str, float]:
    """The largest line of each gauge by the model alone, by which deviations of the maps are counted."""
    return fitted.unit.largest or largest_lines(fitted.calibrated.predicted, fitted.measured.layout)


def _as_it_is(measured: Measured, unit: Unit) -> Fitted:
    """The fit to recordings of the healthy gear, whatever structure it has."""
    return _about_its_lines(_learning(_as_accurate_as_shown(measured, unit)))


def _foreign(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> Bool[np.ndarray, " feature"]:
    """Ripple of speed and torques that is not the model's, as where the torque is that of the brake: features of it."""
    layout, shares = measured.layout, _unexplained(measured, missed)
    drive = [name for name, share in shares.items() if name not in SENSORS and share > UNEXPLAINED]
    return np.isin(layout.channel, drive) & (layout.order > 0)


def _as_accurate_as_shown(measured: Measured, unit: Unit) -> Fitted:
    """The fit at the accuracy of the structural model that is shown: the declared one, or a coarser one while a channel
    is missed and that makes the recordings likelier.
    """
    best = fit(measured, unit, position=_by_drive_alone(measured, unit))
    for structure in COARSER:
        if max(best.misfit.values()) < WELL:
            break
        coarser = _again(best, structure=structure)
        if coarser.log_likelihood <= best.log_likelihood:
            break
        best = coarser
    return best


def _by_drive_alone(measured: Measured, unit: Unit) -> dict[str, float]:
    """Where speed and torques alone have the parameters: gauges on quite another flex spline would lead them astray."""
    drive = tuple(name for name in measured.layout.channels if name not in SENSORS)
    if not drive:
        return {}
    heard = np.isin(measured.layout.channel, drive)
    alone = Measured(measured.recordings, Layout(drive), measured.values[:, heard], measured.variance[:, heard])
    unit = replace(unit, inflation=None if unit.inflation is None else unit.inflation[heard])
    position: dict[str, float] = {}
    for _ in range(DRIVES):
        fitted = fit(alone, unit, position=position)
        position = dict(fitted.calibrated.position)
        if fitted.calibrated.settled:
            break
    return position


def _again(fitted: Fitted, **changes: Any) -> Fitted:
    """A fit to a unit of which other things are declared, from where the parameters were found."""
    unit = replace(fitted.unit, **changes)
    was, now = fitted.parameters, {**fitted.parameters, **unit.declared}
    position = {name: by * was[name].sd / now[name].sd for name, by in fitted.calibrated.position.items()}
    return fit(fitted.measured, unit, position=position)


def _learning(fitted: Fitted) -> Fitted:
    """The fit in which lines that are missed may lie as far off as they do, so that they are learned."""
    measured, layout = fitted.measured, fitted.measured.layout
    beyond = _beyond(measured, fitted.missed)
    off = np.sqrt((fitted.residual.reshape(measured.values.shape) ** 2).mean(axis=0)) * (beyond > 1)
    largest = largest_lines(fitted.calibrated.predicted, layout)
    missed = _unexplained(measured, fitted.missed)
    for channel in layout.channels:
        own = layout.channel == channel
        if channel in largest:
            off[own] = np.minimum(off[own], LOOSEST * max(largest.values()))
        elif missed[channel] > ALIEN:
            off[own] = 0.0
    return _again(fitted, learned=off) if off.any() else fitted


def _beyond(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> Float[np.ndarray, " feature"]:
    """How much larger the variance of every line is than noise and declared spreads make it; 1 where that is luck.

    What the model misses is alike in all repeats of an operating point, and part of it in all recordings, which must
    not pass for as many witnesses; and it misses as much of each of the gauges s1 to s4, which sit alike.

    Parameters
    ----------
    measured : Measured
    missed : array (recording, feature)
        In standard deviations of what is declared.
    """
    layout = measured.layout
    single, common = missed**2, len(missed) * missed.mean(axis=0) ** 2
    repeats = len(measured) / len(measured.point_rows())
    alike = np.array(["s1 to s4" if name in SENSORS[1:] else name for name in layout.channel])
    every = dict.fromkeys(zip(alike, layout.order, strict=True))
    lines = [(alike == channel) & (layout.order == order) for channel, order in every]
    by_single = [chi2.sf(single[:, line].sum(), single[:, line].size) for line in lines]
    in_common = [chi2.sf(common[line].sum(), line.sum()) for line in lines]
    missed_by = false_discovery_control([*by_single, *in_common]).reshape(2, -1) < LUCK
    beyond = np.ones(len(layout))
    for line, by_one, by_all in zip(lines, *missed_by, strict=True):
        if by_one:
            beyond[line] = 1 + repeats * (single[:, line].mean() - 1)
        if by_all:
            beyond[line] = np.maximum(beyond[line], common[line].mean())
    return beyond


def _unexplained(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> dict[str, float]:
    """Share of every channel's ripple that the model leaves unexplained, beyond noise; 0 where that is hardly more."""
    layout = measured.layout
    square = (missed**2).mean(axis=0)
    left = np.maximum(square - 1, 0) * measured.variance.mean(axis=0)
    power = (measured.values**2).mean(axis=0)
    shares = {}
    for channel in layout.channels:
        ripple = (layout.channel == channel) & (layout.order > 0)
        more = square[ripple].max() > MISFIT
        shares[channel] = float(np.sqrt(left[ripple].sum() / power[ripple].sum())) if more else 0.0
    return shares


def _require_own(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> None:
    """Refuse a healthy gear of which the model leaves more than UNEXPLAINED of a channel's ripple, beyond noise."""
    shares = _unexplained(measured, missed)
    poor = sorted(((share, name) for name, share in shares.items() if share > UNEXPLAINED), reverse=True)
    if poor:
        differ = ", ".join(f"{name} ({100 * share:.0f} %)" for share, name in poor)
        raise ValueError(
            f"the model cannot be commissioned on these recordings: it leaves {differ} of the ripple unexplained, at "
            f"most {100 * UNEXPLAINED:.0f} % may be. Correct the gear file (load inertia J_out, "
            "speed control), the zero of the angle or a channel that is none of this gear, or leave that channel out"
        )
