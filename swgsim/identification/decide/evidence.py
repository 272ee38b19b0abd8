"""The evidence of a fit, and what an effect is expected to add to it."""

import numpy as np
from jaxtyping import Float
from scipy.special import logsumexp

from swgsim.identification.decide.forms import Forms
from swgsim.identification.decide.line_evidence import OpenLines, log_volume, with_effect_known
from swgsim.identification.decide.prior import (
    BALANCED,
    FORM_ERRORS,
    LINE_ERROR,
    LOG_SIZE_RANGE,
    TIMES_BALANCED,
)
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import form_directions, parts

# Factors on the deviation of the zeros of gauges.
ZEROS = (1.0, *TIMES_BALANCED)


def log_evidences(fitted: Fitted) -> tuple[Float[np.ndarray, "zeros form_error"], Forms | OpenLines]:
    """Log evidence of a fit by the factor on the deviation of zeros and by the form error, and the forms of effects.

    The priors of zeros and form error are in it, and all parameters are integrated over their priors (Laplace). The
    form errors gain the same for all factors of zeros. Where lines differ one by one, bridges count as not balanced
    anew: their offsets are among the lines.
    """
    fitted = fitted.with_zeros(1.0)
    if any(map(fitted.unit.opens, fitted.added)):
        return _with_open_lines(fitted)
    measured, whole = fitted.measured, fitted.whole
    # Further zeros open like forms, each kind by a factor of its own.
    zeros = Forms.of([whole.whiten(each) for each in measured.free_zeros], fitted.white)
    balanced = np.log([1 - BALANCED, *[BALANCED / len(TIMES_BALANCED)] * len(TIMES_BALANCED)])
    of_zeros = balanced + fitted.log_likelihood + [zeros.gain(measured.beyond_zeros(times)) for times in ZEROS]
    likeliest = ZEROS[int(of_zeros.argmax())]
    best = whole.with_columns(measured.further_zeros(likeliest)) if likeliest > 1 else whole
    forms = Forms.of([best.whiten(each) for each in form_directions(fitted)], best.whiten(fitted.from_start))
    gains = [forms.gain([error] * len(fitted.added)) for error in FORM_ERRORS]
    return of_zeros[:, None] + gains - np.log(len(gains)), forms


def _with_open_lines(fitted: Fitted) -> tuple[Float[np.ndarray, "zeros form_error"], OpenLines]:
    """The same of a fit with one effect, whose lines differ one by one."""
    held = with_effect_known(fitted)
    lines = OpenLines.of(fitted, held)
    volume = log_volume(fitted, held.whole.with_columns(lines.opened(LINE_ERROR)))
    evidences = np.full((len(ZEROS), 1), -np.inf)
    evidences[0] = np.log(1 - BALANCED) + held.log_likelihood + lines.gain([LINE_ERROR]) + volume
    return evidences, lines


def expected_gain(fitted: Fitted, change: Float[np.ndarray, " row"]) -> float:
    """Log evidence that an effect is expected to bring with its prior of the size, without a fit.

    It is relative to an evidence with the prior of one form error, as in :attr:`Option.evidences`.

    Parameters
    ----------
    fitted : Fitted
        The model without the effect.
    change : array (row,)
        What the effect changes at its estimated size, which stands for the standard deviation of its prior.
    """
    whole = fitted.whole
    size = whole.whiten(change[:, None])
    forms = Forms.of([size, whole.whiten(parts(fitted, change))], fitted.white)
    return float(logsumexp([forms.gain([1.0, error]) for error in FORM_ERRORS])) - float(np.log(LOG_SIZE_RANGE))
