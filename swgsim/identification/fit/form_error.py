"""Form error: how much the lines of an effect may differ from those in the library."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from swgsim.identification.covariance.low_rank_covariance import significant_columns
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted

# Least gain of log-likelihood by which one explanation counts as better than another.
LEAST_GAIN = 3.0
# Typical share by which the parts of a real cause differ from the library's form (standard deviation).
FORM_TOLERANCE = 0.2


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


def allowance(fitted: Fitted, number: int) -> Float[np.ndarray, "row part"]:
    """What an imperfect form of an effect leaves open; without it the form error would pass for another effect.

    Every line of every channel of its signature may be larger or smaller, and turned, by the form tolerance, but the
    whole of it may not: that is its size.
    """
    measured, layout = fitted.measured, fitted.measured.layout
    signed = signature(fitted, number)
    if not signed.any():
        return np.zeros((len(signed), 0))
    lines = layout.lines(signed.reshape(measured.values.shape))
    columns = [parts(fitted, signed)]
    for turn in (1, 1j):
        for channel in range(lines.shape[1]):
            for order in np.flatnonzero(np.abs(lines[:, channel]).max(axis=0) > 0):
                one = np.zeros_like(lines)
                one[:, channel, order] = turn * lines[:, channel, order]
                columns.append(layout.vector(one).reshape(-1, 1))
    whole, open_ = signed[:, None], np.hstack(columns)
    weighed = whole / fitted.errors.variance[:, None]
    return FORM_TOLERANCE * (open_ - whole @ (weighed.T @ open_) / float((weighed * whole).sum()))


def form_directions(fitted: Fitted) -> list[Float[np.ndarray, "row direction"]]:
    """Directions of the form error of each added effect, for a form error of 1."""
    columns = (allowance(fitted, number) for number in fitted.numbers_added)
    return [significant_columns(each, fitted.errors.variance) / FORM_TOLERANCE for each in columns]


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
