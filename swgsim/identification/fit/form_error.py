"""Whether an effect is the cause and no mimic: one size must serve all operating points, channels and orders."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from swgsim.common.singular import svd
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted

# Least gain of log-likelihood by which one explanation counts as better than another. An explanation counts as better
# than none by the same gain.
LEAST_GAIN = 3.0
# A regularity replaces an effect only if it explains more than the effect does. The excess must be above the first
# number, a sum of squares, plus the second number times what the effect explains.
OUTDONE, OUTDONE_SHARE = 17.0, 0.05
# A real cause never has the library's exact shape: its parts may differ from it by this share, and the power of load
# and speed that it goes with by as much (standard deviations).
FORM_TOLERANCE = 0.2
# Load below which a power of it is that of this one [N m].
LEAST_LOAD = 1.0
# Form errors of which the most probable one is selected.
FORM_ERRORS = np.append(0.0, np.geomspace(1e-3, 10, 200))
# Probability below which the parts contradict one another even so.
CONTRADICTION = 1e-3
# Parts that differ so much have no size in common: the standard deviation is this share of the size, so a size of zero
# is only two standard deviations away.
NO_SIZE = 0.5
# Parts of points, of channels and of orders have the same sum; directions of them below this share of the largest are
# what differences and rounding leave of that (an estimate).
LEAST_PART = 1e-3


@dataclass(frozen=True)
class Coherence:
    """How well one size of an effect serves all of its signature.

    Attributes
    ----------
    chance : float
        Probability of such a disagreement between the parts, if their form is right to FORM_TOLERANCE.
    form_error : float
        Share by which the parts likeliest differ from the library's shape.
    doubt : float
        Share by which such parts make the size uncertain, which is a mean over them (standard deviation).
    disagreement : float
        That by the parts alone, where they differ beyond noise; 0 where noise may be all of it.
    """

    chance: float
    form_error: float
    doubt: float
    disagreement: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether the parts agree, and so well that there is a size."""
        return self.chance > CONTRADICTION and self.disagreement < NO_SIZE

    @property
    def tolerated(self) -> float:
        """The part of the form error that is within the tolerance."""
        return min(self.form_error, FORM_TOLERANCE)


def signature(fitted: Fitted, number: int) -> Float[np.ndarray, " row"]:
    """What one effect of the model does to the features, by the chain with and without it."""
    measured = fitted.measured
    found = predict([fitted.model, fitted.model.without(number)], measured.situations, measured.layout)
    return measured.rows(found[0] - found[1])


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
    columns = [forms(fitted, signed)]
    for turn in (1, 1j):
        for channel in range(lines.shape[1]):
            for order in np.flatnonzero(np.abs(lines[:, channel]).max(axis=0) > 0):
                one = np.zeros_like(lines)
                one[:, channel, order] = turn * lines[:, channel, order]
                columns.append(layout.vector(one).reshape(-1, 1))
    whole, open_ = signed[:, None], np.hstack(columns)
    weighed = whole / fitted.errors.variance[:, None]
    return FORM_TOLERANCE * (open_ - whole @ (weighed.T @ open_) / float((weighed * whole).sum()))


def open_form(fitted: Fitted, added: int) -> Fitted:
    """A fit with the form of the effects that were added last open within the tolerance."""
    count = len(fitted.model.effects)
    return fitted.allowing_forms(np.hstack([allowance(fitted, number) for number in range(count - added, count)]))


def coherence(fitted: Fitted, number: int) -> Coherence:
    """Whether the parts of an effect's signature agree on its size."""
    signed = signature(fitted, number)
    whole = fitted.whole
    split = whole.whiten(forms(fitted, signed))
    if not np.any(split):
        return Coherence(0.0, 0.0, 0.0)
    U, s, _ = svd(split)
    kept = s > LEAST_PART * max(float(s.max()), 1e-12)
    u, s = (U.T @ whole.whiten(fitted.from_start))[kept], s[kept]

    chance = float(chi2.sf((u**2 / (1 + (FORM_TOLERANCE * s) ** 2)).sum(), len(s)))
    wider = 1 + (FORM_ERRORS[:, None] * s) ** 2
    # Minus twice the log-likelihood of the parts, for every form error that is tried.
    minus_2_log_likelihood = (u**2 / wider + np.log(wider)).sum(axis=1)
    error = float(FORM_ERRORS[np.argmin(minus_2_log_likelihood)])
    form_columns = error * parts(fitted, signed)
    shares = _shares(fitted, number, signed, form_columns)
    beyond_noise = minus_2_log_likelihood[0] - minus_2_log_likelihood.min() > as_squares(LEAST_GAIN)
    # An effect in one channel and one order has parts that are the whole of it; they cannot disagree.
    several = (form_columns != error * signed[:, None]).any(axis=0)
    disagreement = float(np.linalg.norm(shares[several])) if beyond_noise else 0.0
    return Coherence(chance, error, float(np.linalg.norm(shares)), disagreement)


def open_as_found(fitted: Fitted, coherences: Sequence[Coherence]) -> Fitted:
    """A fit with the form of the last effects free, by their form error within the tolerance.

    With the exact library form, a slightly different cause would predict other operating points badly, and an effect
    that imitates it would be preferred.
    """
    numbers = range(len(fitted.model.effects) - len(coherences), len(fitted.model.effects))
    by_parts = [
        each.tolerated * forms(fitted, signature(fitted, number))
        for number, each in zip(numbers, coherences, strict=True)
        if each.tolerated
    ]
    return fitted.allowing(np.hstack(by_parts)) if by_parts else fitted


def doubt_by_others(fitted: Fitted, number: int, others: Mapping[int, Coherence]) -> float:
    """Share by which the size of an effect is uncertain, as other effects differ from the library's shape.

    Parameters
    ----------
    fitted : Fitted
    number : int
    others : mapping
        Coherence of each of them by its number.
    """
    off = [each.form_error * parts(fitted, signature(fitted, other)) for other, each in others.items()]
    return float(np.linalg.norm(_shares(fitted, number, signature(fitted, number), np.hstack(off)))) if off else 0.0


def moved_by_forms(fitted: Fitted, coherences: Mapping[int, Coherence]) -> dict[str, float]:
    """Standard deviation by which each fitted parameter is moved, as effects differ from the library's shape.

    Parts of all of them are larger or smaller; that lines are turned is not in it.

    Parameters
    ----------
    fitted : Fitted
    coherences : mapping
        Coherence of each effect by its number.
    """
    off = [np.zeros((len(fitted.residual), 0))]
    for number, each in coherences.items():
        signed = signature(fitted, number)
        off.append(each.form_error * parts(fitted, signed))
    J = fitted.of_unit.whiten(fitted.J)
    moved = np.linalg.solve(J.T @ J + np.eye(J.shape[1]), J.T @ fitted.of_unit.whiten(np.hstack(off)))
    by = np.linalg.norm(moved, axis=1).tolist()
    return {name: share * p.sd for (name, p), share in zip(fitted.parameters.items(), by, strict=True)}


def _shares(
    fitted: Fitted, number: int, signed: Float[np.ndarray, " row"], off: Float[np.ndarray, "row column"]
) -> Float[np.ndarray, " column"]:
    """What errors of a signature, one standard deviation each, add to the size, as shares of it.

    The effect's own parameters are not open beside it: its size is what is asked for, and would leave rounding of it.
    """
    if not off.any():
        return np.zeros(off.shape[1])
    others = [column for column, name in enumerate(fitted.parameters) if f" {number + 1}: " not in name]
    errors = fitted.of_nuisances.with_columns(fitted.J[:, others])
    whole = errors.whiten(signed)
    return errors.whiten(off).T @ whole / (whole @ whole)
