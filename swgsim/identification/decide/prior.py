"""The prior of the decision: one table of all its numbers.

An option is a set of causes that the model may lack. All numbers are estimates, declared before any scored run. They
change only for a reason from physics or from the practice of test benches.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from scipy.special import gammaln

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Quantity, Role, quantities
from swgsim.effects.regularity import LAWS, PATTERNS
from swgsim.identification.data.features import ORDERS
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.priors import name_of

# Probability that a gear which is examined is healthy. Causes occur independently of one another, so their number has a
# Poisson distribution.
HEALTHY = 0.8
# Causes of an option at most. More of them have a probability of 1e-4, and take time.
MOST_CAUSES = 3
# Probability that a cause is not in the library, which holds what the literature describes.
OUTSIDE_LIBRARY = 0.1
# Half of the unknown causes resemble known effects, as they act on the same machine. The others are regularities, each
# being one order, one pattern over the channels and one law.
RESEMBLING = 0.5
# Probability that an unknown cause resembles one more effect, or shows in one more regularity.
ANOTHER = 0.5
# Probability that bridges were balanced anew between two sessions. The zeros of gauges then lie so many times as far
# off as declared.
BALANCED, TIMES_BALANCED = 0.05, (2.0, 4.0, 8.0, 16.0)
# A real effect never has exactly the form that the library gives it. Each line of its signature, and each part of it in
# a channel, at an order or at an operating point, differs by one of these shares (standard deviation), all being
# equally probable: from the mesh of the truss to the model of another author.
FORM_ERRORS = (0.01, 0.02, 0.05, 0.1, 0.2)
# What resembles an effect may look just like it, or have little more than channels, orders and law in common: its form
# error is uniform from 0 to 1. It is integrated over these values.
OTHER_FORMS = (*FORM_ERRORS, 0.35, 0.5, 0.7, 1.0)
# On a gear of another structure, lines differ one by one. A group of them is as in the library with the first
# probability. Otherwise the logarithm of its error is uniform, from so many standard deviations of the noise to this
# share of the largest line of the effect; of what resembles an effect, to all of it.
EXACT_LINE, LEAST_ERROR, LINE_ERROR = 0.5, 0.1, 0.3
# Sizes of effects and amplitudes of regularities are known to a factor only: their logarithm is uniform over so many
# factors of e, a ratio of 3000.
LOG_SIZE_RANGE = 8.0


def log_prior(effects: int, resembled: int, regularities: int, kinds: int) -> float:
    """Logarithm of the prior probability of an option.

    Parameters
    ----------
    effects : int
        Effects of the library; each is as probable as any other one.
    resembled : int
        Further effects that one unknown cause resembles.
    regularities : int
        Regularities by which one unknown cause is described instead; each is as probable as any other one.
    kinds : int
        Number of effects in the library.

    >>> round(float(np.exp(log_prior(0, 0, 0, 60))), 3)
    0.8
    >>> round(float(np.exp(log_prior(1, 0, 0, 60))), 4)
    0.0027
    """
    if effects + bool(resembled or regularities) > MOST_CAUSES:
        return -np.inf
    rate = -np.log(HEALTHY)
    found = np.log(HEALTHY) + effects * np.log(rate * (1 - OUTSIDE_LIBRARY) / kinds)
    if resembled:
        found += np.log(rate * OUTSIDE_LIBRARY * RESEMBLING) + _one_or_more(resembled, kinds)
    elif regularities:
        found += np.log(rate * OUTSIDE_LIBRARY * (1 - RESEMBLING))
        found += _one_or_more(regularities, (ORDERS + 1) * len(PATTERNS) * len(LAWS))
    return float(found)


def uniform_weights(values: Sequence[float]) -> Float[np.ndarray, " value"]:
    """Weights with which increasing values stand for a uniform distribution from 0 to 1, each for all nearest to it.

    >>> uniform_weights((0.1, 0.2, 0.5, 1.0)).round(2).tolist()
    [0.15, 0.2, 0.4, 0.25]
    """
    between = (np.array(values)[1:] + values[:-1]) / 2
    return np.diff([0.0, *between, 1.0])


def _one_or_more(number: int, among: int) -> float:
    """Logarithm of the probability of one set of so many, the number being geometric."""
    return float(np.log((1 - ANOTHER) / ANOTHER) + number * np.log(ANOTHER / among) + gammaln(number + 1))


def log_choices(kind: type[Effect]) -> float:
    """Logarithm of the number of variants of an effect, such as one for each gauge; all are equally probable.

    >>> from swgsim.effects.gauge_gain import GaugeGain
    >>> round(float(np.exp(log_choices(GaugeGain))))
    6
    """
    return float(sum(np.log(len(q.tried)) for q in quantities(kind).values() if q.role is Role.CHOICE))


def log_density(q: Quantity, value: float, deviation: float) -> float:
    """Logarithm of the prior density of a fitted parameter of an effect.

    A size is uniform in its logarithm, down to its standard deviation, below which all sizes look alike. Every other
    parameter is uniform within its bounds.

    Parameters
    ----------
    q : Quantity
    value : float
        The value found, in the unit of the parameter.
    deviation : float
        Its standard deviation.
    """
    if q.role is Role.SIZE:
        both_signs = q.low < q.nothing < q.high
        return -float(np.log(LOG_SIZE_RANGE * max(abs(value - q.nothing), deviation) * (1 + both_signs)))
    return -float(np.log(q.high - q.low))


def prior_ratio(
    fitted: Fitted, number: int, deviation: Mapping[str, float], position: Mapping[str, float] | None = None
) -> float:
    """Logarithm of the prior density of the parameters of an added effect over that of the fit, where it found them.

    The fit has a normal prior about where each parameter began. A position or a shape that the recordings do not tell
    has the ratio 1: its prior, whatever it is, integrates to 1. Variants of an effect share its prior.

    Parameters
    ----------
    fitted : Fitted
    number : int
        Of the effect among those of the model.
    deviation : mapping
        Standard deviation of each fitted parameter, in its unit.
    position : mapping, optional
        Where the fit found each, in spreads from the middle of its prior; by default in the middle.
    """
    effect = fitted.model.effects[number]
    found = -log_choices(type(effect))
    for name, q in quantities(type(effect)).items():
        if (key := name_of(effect, number, name)) in fitted.parameters:
            value, sd = float(getattr(effect, name)), fitted.parameters[key].sd
            found += ratio_of_parameter(q, value, deviation[key], sd, 0.0 if position is None else position[key])
    return float(found)


def ratio_of_parameter(q: Quantity, value: float, deviation: float, sd: float, position: float) -> float:
    """The same for one parameter, of which the fit has a normal prior with the standard deviation ``sd``.

    Parameters
    ----------
    q : Quantity
    value : float
        Found by the fit.
    deviation : float
        Its posterior standard deviation.
    sd : float
    position : float
        How far the value lies from the middle of that prior, in ``sd``.
    """
    ratio = log_density(q, value, deviation) + np.log(2 * np.pi * sd**2) / 2
    told = 1 - min(deviation / sd, 1.0) ** 2  # share of the variance that the recordings take away
    if q.role is not Role.SIZE:
        ratio = min(ratio - np.log(max(told, 1e-12)) / 2, -np.log(deviation / sd))
    return float(ratio + position**2 / 2)
