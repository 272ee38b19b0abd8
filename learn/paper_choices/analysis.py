"""What the trials say: which choice moves which cell, what else fits as well, and on what each claim depends."""

from collections.abc import Callable, Mapping, Sequence
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
    deviation : float
        Of the difference between the objectives of two sets of values, over folds and forests [points].
    intervals : mapping
        Choice that the fit sees to its least and largest value among the trials that fit as well.
    as_well : int
        Number of those trials.
    """

    values: Values
    deviation: float
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


def reduced(
    values: Values, choices: Sequence[Choice], alone: Callable[[Sequence[Values]], list[float]],
    repeated: Callable[[Values], Float[np.ndarray, " seed"]],
) -> tuple[Values, float]:  # fmt: skip
    """Put choices back to their usual values, those that cost least alone first, as long as the rest fits as well.

    Values fit as well if their objective is at most two standard errors above that of the given values, with the same
    seeds: folds and forests scatter more than the difference.

    Parameters
    ----------
    values : mapping
        Those of the best trial.
    choices : sequence of Choice
    alone : callable
        From sets of values to their objectives with one seed [points].
    repeated : callable
        From values to their objectives with several seeds [points].

    Returns
    -------
    values : mapping
        Those given for the few choices that are needed; the usual value of all others.
    deviation : float
        Standard deviation over the seeds of a difference between two sets of values [points]; if all values are usual,
        that of two independent objectives.
    """
    usual = {each.name: each.usual for each in choices if values[each.name] != each.usual}
    costs = dict(zip(usual, alone([{**values, name: usual[name]} for name in usual]), strict=True))
    best = repeated(values)
    variances = [] if costs else [2 * best.var(ddof=1)]
    for name in sorted(costs, key=lambda name: costs[name]):
        fewer = {**values, name: usual[name]}
        excess = repeated(fewer) - best
        variances.append(excess.var(ddof=1))
        if excess.mean() <= 2 * np.sqrt(variances[-1] / len(excess)):
            values = fewer
    return values, float(np.sqrt(np.mean(variances)))


def fit(best: Trial, values: Values, trials: Sequence[Trial], deviation: float, choices: Sequence[Choice]) -> Fit:
    """The values that were found, and the intervals of all trials within two standard deviations of the best one."""
    near = [trial for trial in trials if trial.objective <= best.objective + 2 * deviation]
    columns = {each.name: [trial.values[each.name] for trial in near] for each in choices if each.fitted}
    return Fit(values, deviation, {name: (min(c), max(c)) for name, c in columns.items()}, len(near))


def best_of(trials: Sequence[Trial], choices: Sequence[Choice]) -> Trial:
    """The trial with the least objective; what the fit does not see has its usual value."""
    best = min(trials, key=lambda trial: trial.objective)
    usual = {each.name: each.usual for each in choices if not each.fitted}
    return replace(best, values={**best.values, **usual})


def effects(trials: Sequence[Trial], choices: Sequence[Choice]) -> pd.DataFrame:
    """Change of each cell for one standard deviation of each choice's prior [points], over the drawn trials.

    Each slope is that over one choice alone, so chance correlations of the choices in few draws enter.

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


def interval(share: float, draws: int) -> tuple[float, float]:
    """The 95 % interval of a share of independent draws (Clopper and Pearson).

    >>> low, high = interval(29 / 32, 32)
    >>> round(low, 2), round(high, 2)
    (0.75, 0.98)
    """
    from scipy.stats import binomtest

    ends = binomtest(round(share * draws), draws).proportion_ci()
    return float(ends.low), float(ends.high)


def parts_held(trials: Sequence[Trial]) -> dict[str, dict[str, float]]:
    """The share of the drawn trials in which each part of C11 to C18 holds."""
    judged = [parts(trial.tables) for trial in trials if trial.sampled]
    return {
        key: {part.name: float(np.mean([each[key][i].holds for each in judged])) for i, part in enumerate(of_claim)}
        for key, of_claim in judged[0].items()
    }


def _deviations(trials: Sequence[Trial], choices: Sequence[Choice]) -> Float[np.ndarray, "trial choice"]:
    return np.array([[each.deviation(trial.values[each.name]) for each in choices] for trial in trials])
