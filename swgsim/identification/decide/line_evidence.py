"""Evidence of effects whose lines differ one by one from the library's, on a gear of another structure.

The errors of lines are known to a factor only (:mod:`line_errors`), so the residual that such an effect leaves has no
normal distribution. The evidence is that of the residual at the fitted parameters of the effect, times the volume of
these: their prior density, and their spread about the fit with the errors of lines open.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import quantities
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.decide.forms import OpenLines
from swgsim.identification.decide.line_errors import LineErrors, groups
from swgsim.identification.decide.prior import log_choices, log_density
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.priors import name_of


def opened(fitted: Fitted) -> list[int]:
    """Numbers of the effects of the model whose lines differ one by one."""
    return [number for number in fitted.numbers_added if fitted.unit.opens(fitted.model.effects[number])]


def parameters_of(fitted: Fitted, number: int) -> dict[str, str]:
    """The fitted parameters of an effect, by the name of each in the fit."""
    effect = fitted.model.effects[number]
    names = {name_of(effect, number, name): name for name in quantities(type(effect))}
    return {key: name for key, name in names.items() if key in fitted.parameters}


def holding(fitted: Fitted, numbers: Sequence[int]) -> Fitted:
    """The same fit with the parameters of some effects known."""
    held = {key for number in numbers for key in parameters_of(fitted, number)}
    kept = [n for n, name in enumerate(fitted.parameters) if name not in held]
    position = {name: by for name, by in fitted.calibrated.position.items() if name not in held}
    return replace(
        fitted,
        parameters={name: each for name, each in fitted.parameters.items() if name not in held},
        calibrated=replace(fitted.calibrated, position=position, J=fitted.calibrated.J[..., kept]),
    )


def open_lines(held: Fitted, changes: Mapping[int, Float[np.ndarray, " row"]], effects: int) -> OpenLines:
    """What the errors of lines explain of the residual of a fit.

    Parameters
    ----------
    held : Fitted
        With the parameters of these effects known.
    changes : mapping
        Signature of each effect whose lines differ, by its number among the added ones.
    effects : int
        Number of added effects.
    """
    found = groups(held.measured)
    errors = LineErrors.of(held.whole.whiten(found.columns), found)
    largest = np.zeros(effects)
    for number, signature in changes.items():
        largest[number] = found.largest(found.weights.T @ signature)
    return OpenLines(errors, errors.directions.T @ held.white, largest)


def log_volume(fitted: Fitted, numbers: Sequence[int], errors: Covariance) -> float:
    """Logarithm of the prior probability of a volume that the parameters of effects fill about the fit.

    Parameters
    ----------
    fitted : Fitted
    numbers : sequence of int
        Of the effects.
    errors : Covariance
        Of the residual with these parameters known, the errors of lines being open.
    """
    names = [(number, key, name) for number in numbers for key, name in parameters_of(fitted, number).items()]
    columns = [list(fitted.parameters).index(key) for _, key, _ in names]
    white = errors.whiten(fitted.J[:, columns])
    covariance = np.linalg.inv(white.T @ white + np.eye(len(names)))
    found = (np.linalg.slogdet(2 * np.pi * covariance)[1]) / 2
    for (number, key, name), variance in zip(names, np.diag(covariance), strict=True):
        effect, sd = fitted.model.effects[number], fitted.parameters[key].sd
        value = float(getattr(effect, name))
        found += np.log(sd) + log_density(quantities(type(effect))[name], value, float(np.sqrt(variance)) * sd)
    return float(found - sum(log_choices(type(fitted.model.effects[number])) for number in numbers))
