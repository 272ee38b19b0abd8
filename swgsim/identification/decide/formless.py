"""Something unknown without a simple form: every line may deviate at every operating point, as repeats agree."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from swgsim.identification.decide.option import Option, log_evidences
from swgsim.identification.decide.prior import log_prior
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.regularities import describe, other_laws


def formless(base: Option, kinds: int) -> Option:
    """An option with something unknown that no few regularities describe.

    Parameters
    ----------
    base : Option
        The option that it is added to. Its regularities, or else the strongest one, describe the unknown.
    kinds : int
        Number of effects in the library.
    """
    fitted = base.fitted.with_zeros(base.zeros)
    first, *others = describe(fitted)
    regularities = base.regularities or (replace(first, rivals=other_laws(first, others)),)
    opened = replace(base.fitted.allowing(line_deviations(fitted)))
    more = log_prior(len(base.effects), len(regularities), kinds)
    more -= log_prior(len(base.effects), len(base.regularities), kinds)
    return Option(opened, base.effects, regularities, base.log_prior + more, *log_evidences(opened))


def ill_fitting(option: Option) -> bool:
    """Whether an option leaves more unexplained than deviations of all lines at all operating points would cost."""
    measured = option.fitted.measured
    return bool(option.misfit > len(measured.layout) * len(measured.point_rows()))


def line_deviations(fitted: Fitted) -> Float[np.ndarray, "row deviation"]:
    """One column for every line at every operating point, with the standard deviation that its channel shows."""
    measured, layout = fitted.measured, fitted.measured.layout
    points = [rows.reshape(measured.values.shape)[:, 0] for rows in measured.point_rows()]
    means = np.array([fitted.residual.reshape(measured.values.shape)[rows].mean(axis=0) for rows in points])
    square = {channel: float(np.mean(means[:, layout.channel == channel] ** 2)) for channel in layout.channels}
    sd = np.sqrt([square[channel] for channel in layout.channel])
    at_point = np.stack(points, axis=1).astype(float)
    return np.kron(at_point, np.diag(sd))
