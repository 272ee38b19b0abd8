"""A unit as recordings of its healthy state show it."""

import numpy as np

from swgsim.loop.declared import of_unit
from swgsim.loop.fitting import fit
from swgsim.loop.form import form_columns, largest_lines
from swgsim.loop.session import Measured
from swgsim.loop.unit import Unit
from swgsim.turning import forget

# Mean square of a healthy gear's residual, in units of what is declared of it, beyond which the model is not its own.
MISFIT = 3.0


def commission(measured: Measured, unit: Unit) -> Unit:
    """The unit with what recordings of its healthy state say about it.

    Raises
    ------
    ValueError
        If the model does not describe the healthy gear: what it misses would later pass for an effect.
    """
    forget()
    fitted = fit(measured, unit)
    poor = sorted(((size, name) for name, size in fitted.misfit.items() if size > MISFIT), reverse=True)
    if poor:
        differ = ", ".join(f"{name} ({np.sqrt(size):.1f} times)" for size, name in poor)
        raise ValueError(
            f"the model cannot be commissioned on these recordings: {differ} differ from it by more than noise and "
            f"declared spreads allow (at most {np.sqrt(MISFIT):.1f} times). Correct the gear file (load inertia J_out, "
            "speed control), the zero of the angle or a channel that is none of this gear, or leave that channel out"
        )
    largest = largest_lines(fitted.calibrated.predicted, measured.layout)
    directions = measured.rows(form_columns(largest, measured.situations, measured.layout))
    columns = np.hstack([fitted.J, directions * unit.structure])
    white = fitted.errors.whiten(columns)
    covariance = np.linalg.inv(white.T @ white + np.eye(columns.shape[1]))
    mean = covariance @ (white.T @ fitted.errors.whiten(fitted.from_start[:, None])[:, 0])
    # The parameters themselves stay where the fit has them; the deviations of the maps take up the rest.
    mean[: fitted.J.shape[1]] -= np.array(list(fitted.calibrated.position.values()))
    scale = np.concatenate([np.ones(fitted.J.shape[1]), np.full(directions.shape[1], unit.structure)])
    nominal = unit.model.gear
    # Declared effects stay as they were found: later fits have parameters of their own for them.
    kept = np.flatnonzero([*(name in of_unit(nominal) for name in fitted.parameters), *[True] * directions.shape[1]])
    reach = scale[kept, None] * np.linalg.cholesky(covariance[np.ix_(kept, kept)])
    return Unit(fitted.model, reach, (scale * mean)[kept], unit.structure, fitted.scatter, nominal, largest)
