"""What the trials say: which choice moves which cell, what else fits as well, and on what each claim depends."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.paper.claims import parts
from learn.paper.published_tables import CELL, paper_table
from learn.paper_choices.choice import Choice
from learn.paper_choices.preset import Values
from learn.paper_choices.search import Trial

# Chance that a choice without influence is named for a claim, all choices together.
FALSE_ALARM = 0.05


@dataclass(frozen=True)
class Fit:
    """The values that were found.

    Attributes
    ----------
    values : mapping
        Fitted values of the few choices that are needed; the usual value of all others (:func:`reduced`).
    scatter : (mean, standard deviation)
        Of the objective under the best values [points]. The deviation is that over other folds and forests, and the
        difference between the few variants of a trial and all of them.
    intervals : mapping
        Choice to the least and the largest value among the trials that fit as well.
    as_well : int
        Number of those trials.
    """

    values: Values
    scatter: tuple[float, float]
    intervals: Mapping[str, tuple[float, float]]
    as_well: int


@dataclass(frozen=True)
class Held:
    """How often a claim holds over the drawn choices, and the choices that decide it."""

    share: float
    depends_on: tuple[str, ...]

    @property
    def words(self) -> str:
        """The reading of a claim.

        >>> Held(1.0, ()).words, Held(0.4, ("window",)).words, Held(0.4, ()).words
        ('always', 'depends on window', 'seldom')
        """
        if self.share in (0.0, 1.0):
            return "always" if self.share else "never"
        if self.depends_on:
            return f"depends on {', '.join(self.depends_on)}"
        return "mostly" if self.share > 0.5 else "seldom"


def scatter(repeats: Sequence[float], judged: float) -> tuple[float, float]:
    """Mean and standard deviation of the objective of the best values [points].

    A trial sees few variants, so the difference of its objective to that on all variants is an uncertainty of it.

    Parameters
    ----------
    repeats : sequence of float
        Objective of the best values with other seeds [points].
    judged : float
        The same with all variants [points].

    >>> scatter([5.0, 5.2], judged=5.1)[0]
    5.1
    """
    mean = float(np.mean(repeats))
    return mean, float(np.hypot(np.std(repeats, ddof=1), judged - mean))


def reduced(
    values: Values, choices: Sequence[Choice], objectives: Callable[[Sequence[Values]], list[float]], limit: float
) -> tuple[Values, list[Trial]]:
    """Put choices back to their usual values, those that cost least alone first, as long as the rest fits as well.

    Parameters
    ----------
    values : mapping
        Those of the best trial.
    choices : sequence of Choice
    objectives : callable
        From sets of values to their objectives [points].
    limit : float
        Largest objective that fits as well [points].

    Returns
    -------
    values : mapping
        Those of the best trial for the few choices that are needed; the usual value of all others.
    trials : list of Trial
        All that were tried.
    """
    usual = {each.name: each.usual for each in choices if values[each.name] != each.usual}
    alone = [{**values, name: usual[name]} for name in usual]
    costs = objectives(alone)
    tried = [Trial(False, *each, {}, {}) for each in zip(alone, costs, strict=True)]
    for name, _ in sorted(zip(usual, costs, strict=True), key=lambda each: each[1]):
        fewer = {**values, name: usual[name]}
        (found,) = objectives([fewer])
        tried.append(Trial(False, fewer, found, {}, {}))
        if found <= limit:
            values = fewer
    return values, tried


def fit(best: Trial, trials: Sequence[Trial], scattered: tuple[float, float]) -> Fit:
    """The best trial, and the intervals of all trials that fit as well."""
    near = [trial for trial in trials if trial.objective <= limit(best, scattered)]
    columns = {name: [trial.values[name] for trial in near] for name in best.values}
    return Fit(best.values, scattered, {name: (min(c), max(c)) for name, c in columns.items()}, len(near))


def limit(best: Trial, scattered: tuple[float, float]) -> float:
    """Largest objective that fits as well [points]: two standard deviations above the mean of the best values."""
    return max(scattered[0] + 2 * scattered[1], best.objective)


def best_of(trials: Sequence[Trial], choices: Sequence[Choice], fixed: Collection[str] = ()) -> Trial:
    """The trial with the least objective in which the fixed choices have their usual values.

    What the fit does not see is put back to its usual value, too.
    """
    usual = {each.name: each.usual for each in choices if each.name in fixed or not each.fitted}
    allowed = [trial for trial in trials if all(np.isclose(trial.values[name], usual[name]) for name in fixed)]
    best = min(allowed, key=lambda trial: trial.objective)
    return replace(best, values={**best.values, **usual})


def effects(trials: Sequence[Trial], choices: Sequence[Choice]) -> pd.DataFrame:
    """Change of each cell for one standard deviation of each choice's prior [points], over the drawn trials.

    Returns
    -------
    DataFrame
        Indexed by table, features, row and classifier; one column per choice.
    """
    drawn = [trial for trial in trials if trial.sampled]
    x = _deviations(drawn, choices)
    x = x - x.mean(axis=0)
    parts = {}
    for table in drawn[0].scores:
        y = np.array([trial.scores[table] for trial in drawn], dtype=float)
        slopes = x.T @ (y - y.mean(axis=0)) / (x**2).sum(axis=0)[:, None]
        cells = pd.MultiIndex.from_frame(paper_table(table)[CELL])
        parts[table] = pd.DataFrame(slopes.T, index=cells, columns=[each.name for each in choices])
    return pd.concat(parts, names=["table"])


def held(trials: Sequence[Trial], choices: Sequence[Choice]) -> dict[str, Held]:
    """How often each claim holds over the drawn trials.

    A claim depends on a choice if the values differ between trials in which it holds and those in which it does not
    (Mann-Whitney test, Bonferroni's correction for the number of choices). The most decisive choice is first.
    """
    from scipy.stats import mannwhitneyu

    drawn = [trial for trial in trials if trial.sampled]
    x = _deviations(drawn, choices)
    result = {}
    for key in drawn[0].claims:
        holds = np.array([trial.claims[key] for trial in drawn])
        decisive: dict[str, float] = {}
        if 0 < holds.sum() < len(holds):
            chances = mannwhitneyu(x[holds], x[~holds], axis=0).pvalue
            decisive = {
                each.name: chance
                for each, chance in zip(choices, chances, strict=True)
                if chance < FALSE_ALARM / len(choices)
            }
        result[key] = Held(float(holds.mean()), tuple(sorted(decisive, key=lambda name: decisive[name])))
    return result


def parts_held(trials: Sequence[Trial]) -> dict[str, dict[str, float]]:
    """The share of the drawn trials in which each part of C11 to C18 holds."""
    judged = [parts(trial.tables) for trial in trials if trial.sampled]
    return {
        key: {part.name: float(np.mean([each[key][i].holds for each in judged])) for i, part in enumerate(of_claim)}
        for key, of_claim in judged[0].items()
    }


def _deviations(trials: Sequence[Trial], choices: Sequence[Choice]) -> Float[np.ndarray, "trial choice"]:
    return np.array([[each.deviation(trial.values[each.name]) for each in choices] for trial in trials])
