"""An option: what the model may lack, fitted with everything else, and its evidence."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import combinations

import numpy as np
from jaxtyping import Float
from scipy.special import logsumexp

from swgsim.chain import NoSteadyState
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.identification.decide.evidence import ZEROS, log_evidences
from swgsim.identification.decide.forms import Forms
from swgsim.identification.decide.line_evidence import OpenLines
from swgsim.identification.decide.prior import (
    FORM_ERRORS,
    LINE_ERROR,
    LOG_SIZE_RANGE,
    OTHER_FORMS,
    log_prior,
    prior_ratio,
    uniform_weights,
)
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended
from swgsim.identification.fit.form_error import form_directions
from swgsim.identification.search.regularities import Described, set_free


@dataclass(frozen=True, eq=False)
class Option:
    """A set of causes, fitted with all parameters of the unit.

    Attributes
    ----------
    fitted : Fitted
        The model with the effects; regularities are free within their prior.
    effects : tuple of Effect
        From the library, as fitted.
    regularities : tuple of Described
    log_prior : float
    evidences : array (zeros, form_error)
        Log evidence by the factor on the deviation of zeros and by the form error, with the priors of both.
    forms : Forms or OpenLines
        Of all effects of the fit; of an effect alone whose lines differ one by one, those.
    resembled : tuple of Effect
        Effects of the fit that are not there: one unknown cause resembles them.
    """

    fitted: Fitted
    effects: tuple[Effect, ...]
    regularities: tuple[Described, ...]
    log_prior: float
    evidences: Float[np.ndarray, "zeros form_error"]
    forms: Forms | OpenLines
    resembled: tuple[Effect, ...] = ()

    @property
    def log_evidence(self) -> float:
        """Logarithm of the probability of the recordings, everything else integrated over its prior."""
        return float(logsumexp(self.evidences))

    @property
    def likeliest(self) -> tuple[int, int]:
        """Numbers of the most probable factor of zeros and form error."""
        zeros, form_error = np.unravel_index(self.evidences.argmax(), self.evidences.shape)
        return int(zeros), int(form_error)

    @property
    def zeros(self) -> float:
        """Most probable factor on the deviation of the zeros of gauges."""
        return ZEROS[self.likeliest[0]]

    @property
    def unknown(self) -> bool:
        """Whether something is missing that is not in the library."""
        return bool(self.regularities or self.resembled)

    @property
    def lines_differ(self) -> bool:
        """Whether the lines of its effect may differ one by one from the library's."""
        return isinstance(self.forms, OpenLines)

    @property
    def form_errors(self) -> tuple[float, ...]:
        """Those that its effects may have."""
        return (LINE_ERROR,) if self.lines_differ else FORM_ERRORS

    @property
    def other_forms(self) -> tuple[float, ...]:
        """Those that an unknown cause which resembles its effects may have."""
        return OTHER_FORMS[-1:] if self.lines_differ else OTHER_FORMS

    @property
    def form_error(self) -> float:
        """Root mean square of the form error of the effects, as a share; 0 without effects."""
        if isinstance(self.forms, OpenLines):
            return self.forms.share(LINE_ERROR)
        weights = np.exp(logsumexp(self.evidences, axis=0) - self.log_evidence)
        return float(np.sqrt(weights @ np.square(self.form_errors))) if self.effects else 0.0

    @property
    def fits_badly(self) -> bool:
        """Whether it leaves more unexplained than free values of all lines at all operating points would cost."""
        measured, error = self.fitted.measured, self.form_errors[self.likeliest[1]]
        misfit = self.forms.misfit - 2 * max(self.forms.gain([error] * len(self.fitted.added)), 0.0)
        return misfit > len(measured.layout) * len(measured.point_rows())

    @property
    def log_posterior(self) -> float:
        """Up to a constant that all options share."""
        return self.log_prior + self.log_evidence

    @property
    def causes(self) -> frozenset[object]:
        """The kinds of its effects with their choices, and its regularities."""
        return causes_of(self.effects, self.regularities)

    def opened(self, zeros: int, form_error: int) -> Fitted:
        """The fit with a factor of zeros, and with the form of its effects open by a form error (numbers of both)."""
        error = self.form_errors[form_error]
        if isinstance(self.forms, OpenLines):
            return self.fitted.allowing_forms(self.forms.opened(error))
        directions = np.hstack([np.zeros((len(self.fitted.residual), 0)), *form_directions(self.fitted)])
        return self.fitted.with_zeros(ZEROS[zeros]).allowing_forms(error * directions)


def causes_of(effects: Sequence[Effect], regularities: Sequence[Described]) -> frozenset[object]:
    """What identifies causes: the kinds of effects with their choices, how many of each, and the regularities."""
    return frozenset(Counter(map(kind_of, effects)).items()) | frozenset(each.atom for each in regularities)


def kind_of(effect: Effect) -> tuple[object, ...]:
    """The kind of an effect, and its parameters that are chosen from a list."""
    declared = quantities(type(effect))
    return type(effect), *(getattr(effect, name) for name, q in declared.items() if q.role is Role.CHOICE)


def option(start: Fitted, effects: Sequence[Effect], regularities: Sequence[Described], kinds: int) -> Option:
    """Fit a set of causes.

    Parameters
    ----------
    start : Fitted
        The model that the fit starts from: its effects are kept, and the form of these is open as long as they are
        fitted together with further ones.
    effects : sequence of Effect
        Further effects.
    regularities : sequence of Described
        All regularities of the option.
    kinds : int
        Number of effects in the library.

    Raises
    ------
    NoSteadyState
        If no gear with these effects turns steadily.
    """
    free = reduce(set_free, regularities, start.without_free)
    found = _of_fit(extended(free, effects).closed, regularities, kinds)
    if not found.lines_differ:
        return found
    # The residual of the first fit determines the errors of lines of the second one.
    try:
        again = extended(found.opened(*found.likeliest), ())
    except NoSteadyState:
        return found
    return max(found, _of_fit(again.closed, regularities, kinds), key=lambda each: each.log_posterior)


def _of_fit(fitted: Fitted, regularities: Sequence[Described], kinds: int) -> Option:
    """The option of a fit with its effects and regularities."""
    added = fitted.added
    evidences, forms = log_evidences(fitted)
    if isinstance(forms, Forms):
        deviation, position = fitted.deviation, fitted.calibrated.position
        evidences += sum(prior_ratio(fitted, number, deviation, position) for number in fitted.numbers_added)
    # Where the fit found the amplitude, its normal prior has exp(-1/2) of its largest density.
    evidences += len(regularities) * (0.5 - np.log(LOG_SIZE_RANGE))
    prior = log_prior(len(added), 0, len(regularities), kinds)
    # A copy without what the fit has cached, which would fill the memory.
    return Option(replace(fitted), added, tuple(regularities), prior, evidences, forms)


def resembling(known: Option, kinds: int) -> list[Option]:
    """The options that one unknown cause resembles some of the effects of an option, or all of them.

    The evidence is integrated over the form error of the unknown cause and over that of the known effects; both are
    independent.

    Parameters
    ----------
    known : Option
        With effects of the library alone.
    kinds : int
        Number of effects in the library.
    """
    own, other, many = known.form_errors, known.other_forms, len(known.effects)
    of_fit = logsumexp(known.evidences[:, 0]) + np.log(len(own)) - known.forms.gain([own[0]] * many)
    log_other = np.log(uniform_weights(other))[:, None]
    found = []
    for numbers in (each for n in range(1, many + 1) for each in combinations(range(many), n)):
        shared = own if len(numbers) < many else own[:1]
        gains = [
            [known.forms.gain([unlike if n in numbers else error for n in range(many)]) for error in shared]
            for unlike in other
        ]
        evidence = of_fit + logsumexp(gains + log_other) - np.log(len(shared))
        prior = log_prior(many - len(numbers), len(numbers), 0, kinds) - log_prior(many, 0, 0, kinds)
        found.append(
            replace(
                known,
                effects=tuple(each for number, each in enumerate(known.effects) if number not in numbers),
                resembled=tuple(known.effects[number] for number in numbers),
                evidences=known.evidences + evidence - known.log_evidence,
                log_prior=known.log_prior + prior,
            )
        )
    return found
