"""Something unknown without a simple form: every line may deviate at every operating point, as repeats agree."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from swgsim.identification.decide.option import Option, log_evidences
from swgsim.identification.decide.prior import log_prior
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.regularities import describe, other_laws


def formless(base: Option, kinds: int) -> Option | None:
    """An option with something unknown that no few regularities describe; None where it cannot be more probable.

    Parameters
    ----------
    base : Option
        The option that it is added to. Its regularities, or else the strongest one, describe the unknown.
    kinds : int
        Number of effects in the library.
    """
    fitted = base.fitted.with_zeros(base.zeros)
    deviations = line_deviations(fitted)
    misfit = float(np.sum(fitted.whole.whiten(fitted.from_start) ** 2)) - len(fitted.residual)
    if misfit < deviations.shape[1]:
        return None  # less than the deviations cost
    first, *others = describe(fitted)
    regularities = base.regularities or (replace(first, rivals=other_laws(first, others)),)
    opened = replace(base.fitted.allowing(deviations))
    more = log_prior(len(base.effects), len(regularities), kinds)
    more -= log_prior(len(base.effects), len(base.regularities), kinds)
    return Option(opened, base.effects, regularities, base.log_prior + more, log_evidences(opened))


def line_deviations(fitted: Fitted) -> Float[np.ndarray, "row deviation"]:
    """One column for every line at every operating point, with the standard deviation that its channel shows."""
    measured, layout = fitted.measured, fitted.measured.layout
    points = [rows.reshape(measured.values.shape)[:, 0] for rows in measured.point_rows()]
    means = np.array([fitted.residual.reshape(measured.values.shape)[rows].mean(axis=0) for rows in points])
    square = {channel: float(np.mean(means[:, layout.channel == channel] ** 2)) for channel in layout.channels}
    sd = np.sqrt([square[channel] for channel in layout.channel])
    at_point = np.stack(points, axis=1).astype(float)
    return np.kron(at_point, np.diag(sd))
