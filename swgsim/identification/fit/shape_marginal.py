"""Uncertainty of an effect whose shape is poorly determined: averaged over shapes, weighted by their probability."""

import numpy as np
from jaxtyping import Float
from scipy.integrate import trapezoid

from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.priors import name_of

# Shapes over all of the range, and about the one that was found out to so many of its standard deviations.
EVERYWHERE, ABOUT_FIT, REACH = 25, 25, 6.0


def over_shapes(fitted: Fitted, number: int) -> dict[str, float]:
    """Standard deviation of the size of an effect, and of its shape, about those that were found.

    The derivatives by both tell it only where the recordings do: of a creep of which they saw the start, a slow one is
    as likely as a fast one of half the share. There is nothing to say of an effect without such a shape; of
    several, the derivatives have to do.

    Parameters
    ----------
    fitted : Fitted
        With the effect.
    number : int
    """
    effect = fitted.model.effects[number]
    declared, size = quantities(type(effect)), size_of(type(effect))
    another = fitted.unit.of_another_structure
    searched = [name for name, q in declared.items() if q.role is Role.SHAPE and q.open(another)]
    if len(searched) != 1:
        return {}
    (shape,) = searched
    of_size, of_shape = (name_of(effect, number, name) for name in (size, shape))
    here, near, q = getattr(effect, shape), REACH * fitted.deviation[of_shape], declared[shape]
    close = np.clip(here + np.linspace(-near, near, ABOUT_FIT), q.low, q.high)
    tried = np.unique([*np.linspace(q.low, q.high, EVERYWHERE), *close])
    found, unsure, likely = _sizes(fitted, number, tried, (of_size, of_shape))
    weight = np.exp(likely - likely.max())
    squares = {of_size: unsure**2 + (found - getattr(effect, size)) ** 2, of_shape: (tried - here) ** 2}
    total = trapezoid(weight, tried)
    return {name: float(np.sqrt(trapezoid(weight * each, tried) / total)) for name, each in squares.items()}


def _sizes(
    fitted: Fitted, number: int, tried: Float[np.ndarray, " shape"], own: tuple[str, str]
) -> tuple[Float[np.ndarray, " shape"], Float[np.ndarray, " shape"], Float[np.ndarray, " shape"]]:
    """The likeliest size with each shape, its standard deviation, and how likely all is, everything else being open."""
    effect = fitted.model.effects[number]
    name = size_of(type(effect))
    q = quantities(type(effect))[name]
    others = [column for column, each in enumerate(fitted.parameters) if each not in own]
    # What else the fit left open is still in its residual.
    errors = fitted.of_nuisances.with_columns(fitted.J[:, others])
    without = fitted.model.without(number)
    with_shapes = [fitted.parameters[own[1]].at(fitted.model, value) for value in tried.tolist()]
    predicted = predict([without, fitted.model, *with_shapes], fitted.measured.situations, fitted.measured.layout)
    changes = fitted.measured.rows(np.moveaxis(predicted[1:] - predicted[0], 0, -1))
    position = np.array(list(fitted.calibrated.position.values()))
    left = errors.whiten(fitted.residual + fitted.J[:, others] @ position[others] + changes[:, 0])
    by_one = errors.whiten(changes[:, 1:] / (getattr(effect, name) - q.nothing))
    precision = (by_one**2).sum(axis=0) + 1 / fitted.parameters[own[0]].sd ** 2
    along = by_one.T @ left
    found = np.clip(q.nothing + along / precision, q.low, q.high)
    return found, precision**-0.5, (along**2 / precision - np.log(precision)) / 2
