"""The next experiment: operating point and conditions that separate two explanations (T-optimal design).

One model is taken as the truth. The other model is fitted, with all its nuisance parameters, to the existing recordings
and to the planned ones. The squared distance that remains, in units of the noise, is the separation.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import solve_triangular

from swgsim.common.numbers import significant
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance import narrow_band, scatter
from swgsim.identification.covariance.low_rank_covariance import significant_columns
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.form_error import FORM_TOLERANCE, allowance
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.found_effects import in_words

# Operating points and conditions of a test bench: as it stands, with a warm gear, or after an hour.
FEASIBLE = tuple(OperatingPoint(n, T) for n in (300.0, 1000.0, 2000.0, 3000.0, 4000.0) for T in (3.0, 20.0, 45.0, 70.0))
CONDITIONS = (Conditions(), Conditions(temperature=45.0), Conditions(elapsed=3600.0))
# Heating or waiting must separate clearly better than another operating point.
EASIER = 0.8
# Numbers of further recordings at one operating point, in one session.
RECORDINGS = (1, 2, 3, 6, 12)
# Sufficient separation of two explanations: five standard deviations, squared.
SEPARATED = 25.0
# In place of a second explanation: the model without the first one.
ABSENCE = "its absence"
HELPLESS = "no recordings on this bench"


@dataclass(frozen=True)
class Experiment:
    """Further recordings, and the two explanations that they would separate.

    Attributes
    ----------
    between : (str, str)
        The two explanations.
    situation : Situation
        Operating point and conditions with the largest separation.
    recordings : int or None
        Number that brings the separation to SEPARATED; None if the largest number does not.
    separation : float
        With this number of recordings, or with the largest number.
    """

    between: tuple[str, str]
    situation: Situation
    recordings: int | None
    separation: float

    def __str__(self) -> str:
        one, other = self.between
        point, conditions = self.situation.point, self.situation.conditions
        where = f"at {point.n_in_rpm:g} rpm and {point.T_out:g} N m"
        where += f" with the gear at {conditions.temperature:g} °C" if conditions.warmer else ""
        where += f" {conditions.elapsed / 3600:g} h after the session began" if conditions.elapsed else ""
        aim = f"detect {one}" if other == ABSENCE else f"separate {one} from {other}"
        if self.recordings is None:
            return (
                f"{HELPLESS} can {aim}: even {RECORDINGS[-1]} recordings {where} "
                f"make a difference of {separation_text(self.separation)} standard deviations only, "
                f"{SEPARATED**0.5:g} are needed"
            )
        count = f"{self.recordings} recording{'s' if self.recordings > 1 else ''}"
        return f"to {aim}, make {count} {where} (difference {separation_text(self.separation)} standard deviations)"


def separation_text(separation: float) -> str:
    """A separation in standard deviations; far below one, its value has no meaning.

    >>> separation_text(39.2), separation_text(1e-7)
    ('6.3', 'less than 0.3')
    """
    return "less than 0.3" if separation < 0.1 else significant(separation**0.5, 2)


def next_experiments(answer: Answer) -> tuple[Experiment, ...]:
    """Recordings that separate the answer from the others of the credible set, and that test every absorbed effect."""
    found = []
    after = answer.decision.after
    for rival, _ in answer.decision.credible[1:]:
        names = (in_words(answer.decision.best), in_words(rival))
        found += _best(rival.opened(*rival.likeliest), [after.model], [names])
    effects = [score.hypothesis.effect() for score in answer.absorbed]
    if effects:
        between = [(f"{effect.title()} of typical size", ABSENCE) for effect in effects]
        found += _best(after, [after.model.plus(effect) for effect in effects], between)
    return tuple(found)


def _best(adjusting: Fitted, truths: Sequence[Model], between: Sequence[tuple[str, str]]) -> list[Experiment]:
    """For every truth, the smallest number of recordings that refutes a fitted model, and their operating point."""
    planned = _PlannedRecordings.of(adjusting, truths)
    found: dict[int, Experiment] = {}
    for recordings in RECORDINGS:
        separations = planned.separations(recordings)
        for number in range(len(truths)):
            if number in found and found[number].recordings:
                continue
            best = easiest(separations[:, number])
            most = float(separations[best, number])
            enough = recordings if most >= SEPARATED else None
            found[number] = Experiment(between[number], planned.candidates[best], enough, most)
    return list(found.values())


def easiest(separations: Float[np.ndarray, " candidate"]) -> int:
    """The candidate with the largest separation; one without heating or waiting if it is nearly as good."""
    plain = int(separations[: len(FEASIBLE)].argmax())
    best = int(separations.argmax())
    needed = SEPARATED if separations[best] >= SEPARATED else EASIER * separations[best]
    return plain if separations[plain] >= needed else best


@dataclass(frozen=True, eq=False)
class _PlannedRecordings:
    """A fitted model and planned recordings.

    Attributes
    ----------
    candidates : tuple of Situation
    known : array (truth,)
        Separation by the existing recordings, with all nuisance parameters fitted.
    differences : array (candidate, feature, truth)
        Difference that remains after this fit.
    spread : array (candidate, feature, feature)
        Posterior covariance of the features, with errors that the planned recordings share.
    variance : array (feature,)
        White noise of one recording.
    single : array (candidate, feature, kind)
        Errors of single recordings.
    """

    candidates: tuple[Situation, ...]
    known: Float[np.ndarray, " truth"]
    differences: Float[np.ndarray, "candidate feature truth"]
    spread: Float[np.ndarray, "candidate feature feature"]
    variance: Float[np.ndarray, " feature"]
    single: Float[np.ndarray, "candidate feature kind"]

    @classmethod
    def of(cls, fitted: Fitted, truths: Sequence[Model]) -> "_PlannedRecordings":
        """The part that does not depend on the number of recordings."""
        measured = fitted.measured
        count = len(measured.situations)
        candidates = tuple(Situation(point, conditions) for conditions in CONDITIONS for point in FEASIBLE)
        situations = (*measured.situations, *candidates)
        predicted, directions = _directions(fitted, situations)
        differences = np.moveaxis(predict(truths, situations, measured.layout) - predicted, 0, -1)
        # Differences within the form tolerance, or absorbed by free regularities, gave no information so far.
        errors = fitted.errors.with_columns(fitted.allowed.free)
        for number in fitted.numbers_added:
            errors = errors.with_columns(significant_columns(allowance(fitted, number), errors.variance))
        # The nuisance parameters of the model are fitted to the whitened difference d in the existing recordings. C are
        # their whitened directions. (L L')^-1 is their posterior covariance, and (L L')^-1 C' d their posterior mean.
        C = errors.whiten(measured.rows(directions[:count]))
        d = errors.whiten(measured.rows(differences[:count]))
        L = np.linalg.cholesky(np.eye(C.shape[1]) + C.T @ C)
        fitted_part = solve_triangular(L, C.T @ d, lower=True)
        # A row for each direction of the posterior: what one standard deviation of it changes at the candidates.
        posterior = solve_triangular(L, np.concatenate(directions[count:]).T, lower=True)
        left = np.concatenate(differences[count:]) - posterior.T @ fitted_part
        at_candidates = predicted[count:]
        of_session = measured.further("planned", candidates, at_candidates).session_columns(at_candidates)
        shared = [of_session.reshape(*at_candidates.shape, -1), _tolerance(fitted, candidates, at_candidates)]
        shared.append(posterior.T.reshape(*at_candidates.shape, -1))
        spread = [columns @ columns.T for columns in np.concatenate(shared, axis=-1)]
        single = scatter.directions(fitted.model, candidates, measured.layout)
        noise = np.tile(np.median(measured.variance, axis=0), (len(candidates), 1))
        points = [each.point for each in candidates]
        narrow = narrow_band.columns(fitted.unit.bands, points, measured.layout, noise)
        return cls(
            candidates, (d**2).sum(axis=0) - (fitted_part**2).sum(axis=0), left.reshape(differences[count:].shape),
            np.array(spread), fitted.unit.inflated(noise[0]),
            np.concatenate([fitted.scatter.columns(single), narrow], axis=-1),
        )  # fmt: skip

    def separations(self, recordings: int) -> Float[np.ndarray, "candidate truth"]:
        """Separation of all truths by so many recordings at each candidate."""
        # The mean of the recordings is sufficient: their own errors average out, shared errors do not.
        alone = self.single @ self.single.transpose(0, 2, 1) + np.diag(self.variance)
        further = np.linalg.solve(self.spread + alone / recordings, self.differences)
        return self.known + (self.differences * further).sum(axis=1)


def _directions(
    fitted: Fitted, situations: Sequence[Situation]
) -> tuple[Float[np.ndarray, "situation feature"], Float[np.ndarray, "situation feature direction"]]:
    """Prediction of a model in any situation, and its nuisance directions, one standard deviation each."""
    unsure = fitted.unit.left_open(fitted.model, situations, fitted.measured.layout, fitted.parameters)
    return unsure.predicted, np.concatenate([unsure.columns, unsure.undetermined, unsure.J], axis=-1)


def _tolerance(
    fitted: Fitted, candidates: Sequence[Situation], predicted: Float[np.ndarray, "candidate feature"]
) -> Float[np.ndarray, "candidate feature column"]:
    """Errors of the form of fitted effects at a new operating point: by channel and by order."""
    layout = fitted.measured.layout
    effects = fitted.numbers_added
    if not effects:
        return np.zeros((*predicted.shape, 0))
    without = predict([fitted.model.without(number) for number in effects], candidates, layout)
    masks = [np.ones(len(layout), bool)]
    masks += [layout.channel == channel for channel in layout.channels]
    masks += [layout.order == order for order in np.unique(layout.order)]
    return np.stack([FORM_TOLERANCE * (predicted - each) * mask for each in without for mask in masks], axis=-1)
