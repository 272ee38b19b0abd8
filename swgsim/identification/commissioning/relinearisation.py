"""A fit to a healthy gear, linearised again about the fitted lines where these lie far from the model."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.linalg import qr, solve_triangular

from swgsim.identification.covariance.influence_map_error import largest_lines, lines_of
from swgsim.identification.data.unit_lines import Lines
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit

# So often at most, until the log-likelihood stays within so much.
MOST_ROUNDS, AT_REST = 6, 1.0


def about_its_lines(fitted: Fitted) -> Fitted:
    """The fit linearised about the learned lines.

    Trigger, gains, lags and temperatures act on the whole line, of which the model may contain only a small part.
    """
    if fitted.unit.learned is None:
        return fitted
    largest = largest_of(fitted)
    for _ in range(MOST_ROUNDS):
        _, mean = posterior(fitted)
        lines, form = lines_found(fitted, mean)
        # The prior of the lines is still centred on the model without learned lines.
        back = np.append(np.zeros(fitted.open.shape[1] - form), -mean[len(mean) - form :])
        model = replace(fitted.unit.model, own_lines=lines)
        before, fitted = fitted, again(fitted, model=model, shift=back, largest=largest)
        if abs(fitted.log_likelihood - before.log_likelihood) < AT_REST * fitted.calibrated.lack_of_fit:
            break
    return fitted


def posterior(fitted: Fitted) -> tuple[Float[np.ndarray, "direction direction"], Float[np.ndarray, " direction"]]:
    """Square root of the posterior covariance of all parameters, and their mean, in prior standard deviations.

    It uses orthogonal triangles, because a covariance would lose small standard deviations by rounding.
    """
    columns = np.hstack([fitted.J, fitted.open])
    white = fitted.errors.whiten(columns)
    unity = np.eye(columns.shape[1])
    root = solve_triangular(triangular_factor(np.vstack([white, unity])), unity)
    mean = root @ (root.T @ (white.T @ fitted.errors.whiten(fitted.from_start[:, None])[:, 0]))
    # The parameters themselves stay where the fit has them; all else takes up the rest.
    mean[: fitted.J.shape[1]] -= np.array(list(fitted.calibrated.position.values()))
    return root, mean


def triangular_factor(A: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "column column"]:
    """Upper triangular R with R' R = A' A."""
    return np.asarray(qr(A, mode="r")[0])[: A.shape[1]]


def lines_found(fitted: Fitted, mean: Float[np.ndarray, " direction"]) -> tuple[Lines, int]:
    """The lines by which the gear differs from the model, and how many of the directions, the last ones, they are."""
    unit, layout = fitted.unit, fitted.measured.layout
    sizes = unit.form(fitted.calibrated.predicted, layout)
    form = int(np.count_nonzero(sizes))
    gauges = fitted.model.run(fitted.measured.situations[0]).affected_gear.gauges
    before, found = fitted.model.own_lines, mean[len(mean) - form :]
    if before is None or unit.shift is None:
        return lines_of(sizes, found, layout, gauges), form
    more = lines_of(sizes, found + unit.shift[len(unit.shift) - form :], layout, gauges)
    return before.seen_by(gauges).plus(more), form


def largest_of(fitted: Fitted) -> Mapping[str, float]:
    """The largest line of each gauge in the model without learned lines, which scales deviations of the maps."""
    return fitted.unit.largest or largest_lines(fitted.calibrated.predicted, fitted.measured.layout)


def again(fitted: Fitted, **changes: Any) -> Fitted:
    """A fit of the unit with changed declarations, started at the fitted parameters."""
    return fit(fitted.measured, replace(fitted.unit, **changes), position=fitted.calibrated.position)
