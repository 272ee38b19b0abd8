"""Form error: how much the lines of an effect may differ from those in the library."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from swgsim.chain.structure import LOAD_STEP
from swgsim.effects.base import Effect
from swgsim.identification.covariance.low_rank_covariance import significant_columns
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted
from swgsim.storage.labelled_signals import SENSORS

# Least gain of log-likelihood by which one explanation counts as better than another.
LEAST_GAIN = 3.0
# Typical share by which the parts of a real cause differ from the library's form (standard deviation).
FORM_TOLERANCE = 0.2
# Load below which a power of it is that of this one [N m].
LEAST_LOAD = 1.0


def signature(fitted: Fitted, number: int) -> Float[np.ndarray, " row"]:
    """What one effect of the model does to the features, by the chain with and without it."""
    measured = fitted.measured
    found = predict([fitted.model, fitted.model.without(number)], measured.situations, measured.layout)
    return measured.rows(found[0] - found[1])


def all_show(fitted: Fitted) -> bool:
    """Whether every added effect changes the recordings; clipping above all signals changes nothing."""
    columns = (signature(fitted, number)[:, None] for number in fitted.numbers_added)
    return all(significant_columns(each, fitted.errors.variance).shape[1] for each in columns)


def parts(fitted: Fitted, whole: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row part"]:
    """A signature split by operating point, channel and order."""
    layout = fitted.measured.layout
    channels, orders = (np.tile(what, len(fitted.measured)) for what in (layout.channel, layout.order))
    masks = [
        *fitted.measured.point_rows(),
        *(channels == channel for channel in layout.channels),
        *(orders == order for order in np.unique(orders)),
    ]
    return np.stack([whole * mask for mask in masks], axis=1)


def forms(fitted: Fitted, whole: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row form"]:
    """The parts of a signature; and in a gear of another structure, whose laws may be others too, what another power of
    load and speed makes of it, its mean size being kept.
    """
    split = parts(fitted, whole)
    return np.hstack([split, powers(fitted, whole)]) if fitted.unit.of_another_structure else split


def powers(fitted: Fitted, whole: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row law"]:
    """What another power of the load, and of the speed, makes of a signature, its mean size being kept."""
    points = [recording.point for recording in fitted.measured.recordings]
    laws = [[max(abs(p.T_out), LEAST_LOAD), p.n_in_rpm] for p in points]
    logs = np.repeat(np.log(laws), len(fitted.measured.layout), axis=0)
    weights = whole**2 / fitted.errors.variance
    mean = weights @ logs / max(float(weights.sum()), np.finfo(float).tiny)
    return whole[:, None] * (logs - mean)


def gauge_lines(fitted: Fitted, whole: Float[np.ndarray, " row"]) -> Float[np.ndarray, "row line"]:
    """Every line of a gauge at every load, as large as the largest line of all gauges in a signature.

    Where the sleeve touches the wave generator elsewhere, or the teeth share the load by another law, a signature has
    lines that the library's hardly has.
    """
    measured, layout = fitted.measured, fitted.measured.layout
    of_gauges = np.isin(layout.channels, SENSORS)
    largest = np.abs(layout.lines(whole.reshape(measured.values.shape))[:, of_gauges]).max(initial=0.0)
    loads = np.round([each.point.T_out / LOAD_STEP for each in measured.recordings])
    lines = np.eye(len(layout))[:, layout.of_gauges]
    return largest * np.hstack([np.kron((loads == load)[:, None], lines) for load in np.unique(loads)])


def open_forms(
    fitted: Fitted, signed: Float[np.ndarray, " row"], kind: type[Effect]
) -> Float[np.ndarray, "row direction"]:
    """Directions in which the signature of an effect is open, for a form error of 1.

    Every line of every channel may be larger or smaller, and turned, but the whole of it may not: that is its size.
    """
    measured, layout = fitted.measured, fitted.measured.layout
    if not signed.any():
        return np.zeros((len(signed), 0))
    lines = layout.lines(signed.reshape(measured.values.shape))
    columns = [forms(fitted, signed)]
    for turn in (1, 1j):
        for channel in range(lines.shape[1]):
            for order in np.flatnonzero(np.abs(lines[:, channel]).max(axis=0) > 0):
                one = np.zeros_like(lines)
                one[:, channel, order] = turn * lines[:, channel, order]
                columns.append(layout.vector(one).reshape(-1, 1))
    if fitted.unit.opens(kind):
        columns.append(gauge_lines(fitted, signed))
    whole, open_ = signed[:, None], np.hstack(columns)
    weighed = whole / fitted.errors.variance[:, None]
    beside = open_ - whole @ (weighed.T @ open_) / float((weighed * whole).sum())
    return significant_columns(FORM_TOLERANCE * beside, fitted.errors.variance) / FORM_TOLERANCE


def form_directions(fitted: Fitted) -> list[Float[np.ndarray, "row direction"]]:
    """Directions in which the form of each added effect is open, for a form error of 1."""
    return [
        open_forms(fitted, signature(fitted, number), type(fitted.model.effects[number]))
        for number in fitted.numbers_added
    ]


def with_open_lines(fitted: Fitted, effects: Sequence[Effect]) -> Fitted:
    """A fit in which further effects may have lines that their library form has not, where the structure allows it.

    A fit of these effects without would end at another phase, as it takes such lines for theirs.
    """
    opened = [each for each in effects if fitted.unit.opens(each)]
    if not opened:
        return fitted
    measured, models = fitted.measured, [fitted.model, *map(fitted.model.plus, opened)]
    now, *then = predict(models, measured.situations, measured.layout)
    directions = (
        open_forms(fitted, measured.rows(each - now), type(effect)) for each, effect in zip(then, opened, strict=True)
    )
    return fitted.allowing_forms(FORM_TOLERANCE * np.hstack(list(directions)))


def moved_by_forms(fitted: Fitted, form_errors: Mapping[int, float]) -> dict[str, float]:
    """Standard deviation by which the form errors of effects move each fitted parameter.

    Parameters
    ----------
    fitted : Fitted
    form_errors : mapping
        Form error of each effect by its number, as a share.
    """
    off = [np.zeros((len(fitted.residual), 0))]
    for number, error in form_errors.items():
        signed = signature(fitted, number)
        off.append(error * parts(fitted, signed))
    J = fitted.of_unit.whiten(fitted.J)
    moved = np.linalg.solve(J.T @ J + np.eye(J.shape[1]), J.T @ fitted.of_unit.whiten(np.hstack(off)))
    by = np.linalg.norm(moved, axis=1).tolist()
    return {name: share * p.sd for (name, p), share in zip(fitted.parameters.items(), by, strict=True)}
