"""Uncertainty of comparisons: the bootstrap over gears.

A specimen is one variant of one class of one gear, recorded at several operating points. Recordings of a specimen are
dependent, and so are specimens of a gear. Claims about new gears therefore rest on the number of gears, and gears are
resampled as wholes. The errors of gears already differ by the chance of their specimens: to resample specimens as well
would count that chance twice (Davison and Hinkley, Bootstrap Methods and their Application, 1997, section 3.8).
"""

from collections.abc import Callable

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.evaluation.decisions import decisions, truth
from learn.inputs.inputs import SPECIMEN

FEWEST_GEARS = 5
LEVEL = 0.95

# From mean errors (resample x method) to a statistic, one column per method.
Statistic = Callable[[pd.DataFrame], pd.DataFrame]


def specimens(predictions: pd.DataFrame) -> pd.DataFrame:
    """Share of wrong decisions over the recordings of every specimen, column ``error`` [%]."""
    wrong = predictions[["gear", "variant"]].assign(
        label=truth(predictions), error=100.0 * (decisions(predictions) != truth(predictions))
    )
    return wrong.groupby(list(SPECIMEN))["error"].mean().reset_index()


def mean_error(means: pd.DataFrame) -> pd.DataFrame:
    """Mean error of every method [%]."""
    return means


def difference_to(reference: str) -> Statistic:
    """Mean error of every other method minus that of the reference [points]."""
    return lambda means: means.drop(columns=reference).sub(means[reference], axis=0)


def ratio_to(reference: str) -> Statistic:
    """Mean error of every other method divided by that of the reference [-]; NaN if both are 0."""
    return lambda means: means.drop(columns=reference).div(means[reference], axis=0)


def gear_errors(errors: pd.DataFrame) -> pd.DataFrame:
    """Mean error of every gear (index) and method (column) [%], with equal weights of the classes.

    Raises
    ------
    ValueError
        If a specimen has two rows or an error is missing.
    """
    twice = errors.duplicated(list(SPECIMEN))
    if twice.any():
        raise ValueError(f"specimen {_name(errors[twice])} has two rows: keep one")
    missing = errors.isna().any(axis=1)
    if missing.any():
        raise ValueError(f"specimen {_name(errors[missing])}: an error is missing, judge it by all methods or none")
    values = errors.set_index(list(SPECIMEN))
    return values.groupby(["gear", "label"], observed=True).mean().groupby("gear").mean()


def _name(rows: pd.DataFrame) -> str:
    return ", ".join(str(fact) for fact in rows.iloc[0][list(SPECIMEN)])


def resampled_means(errors: pd.DataFrame, rng: np.random.Generator, *, resamples: int = 2000) -> pd.DataFrame:
    """Mean errors (resample x method) of gears drawn with replacement."""
    by_gear = gear_errors(errors)
    drawn = rng.integers(len(by_gear), size=(resamples, len(by_gear)))
    return pd.DataFrame(by_gear.to_numpy(dtype=float)[drawn].mean(axis=1), columns=by_gear.columns)


def gear_bootstrap(
    errors: pd.DataFrame, statistic: Statistic, rng: np.random.Generator, *, resamples: int = 2000
) -> pd.DataFrame:
    """A statistic of the mean errors with its 95 % interval, one row per method.

    Percentiles are widened for few gears (Hesterberg, The American Statistician 69, 2015), so that a mean over normal
    gears has the width of Student's interval. Plain percentiles are too narrow by a quarter with 5 gears.

    Parameters
    ----------
    errors : DataFrame
        ``gear``, ``label``, ``variant`` and one column of errors [%] per method, one row per specimen.
    statistic : Statistic
        :func:`mean_error`, ``difference_to(reference)`` or ``ratio_to(reference)``.
    rng : Generator
    resamples : int

    Returns
    -------
    DataFrame
        ``value``, ``low``, ``high``; the interval is NaN with fewer than 5 gears.
    """
    by_gear = gear_errors(errors)
    table = statistic(by_gear.mean().to_frame().T).T.set_axis(["value"], axis=1)
    if len(by_gear) < FEWEST_GEARS:
        return table.assign(low=np.nan, high=np.nan)
    return _with_interval(table, statistic(resampled_means(errors, rng, resamples=resamples)), len(by_gear))


def paired_comparison(
    errors: pd.DataFrame, reference: str, rng: np.random.Generator, *, resamples: int = 20_000
) -> pd.DataFrame:
    """Comparison of every method with a reference on the same specimens, with p-values corrected by Holm.

    The p-value is two-sided: the level at which the interval touches zero. The number of resamples limits how small it
    can be, so there are ten times as many as for an interval. With 5 gears the smallest p-value is 0.02.

    Parameters
    ----------
    errors : DataFrame
        As for :func:`gear_bootstrap`.
    reference : str
        Column of the reference method.
    rng : Generator
    resamples : int

    Returns
    -------
    DataFrame
        One row per method: ``value`` (mean difference, negative is better) with ``low`` and ``high`` [points],
        ``better_gears`` (gears in which the method has fewer errors), ``gears``, ``p``, ``p_holm``. With fewer than
        5 gears the interval and both p-values are NaN.

    Raises
    ------
    ValueError
        If the reference is not one of the methods.
    """
    methods = errors.columns.drop(list(SPECIMEN))
    if reference not in methods:
        raise ValueError(f"reference {reference!r} is not among the methods; choose from {', '.join(methods)}")
    statistic = difference_to(reference)
    by_gear = statistic(gear_errors(errors))
    count = len(by_gear)
    table = by_gear.mean().to_frame("value")
    better = (by_gear < 0).sum()
    if count < FEWEST_GEARS or table.empty:
        return table.assign(low=np.nan, high=np.nan, better_gears=better, gears=count, p=np.nan, p_holm=np.nan)
    from statsmodels.stats.multitest import multipletests

    draws = statistic(resampled_means(errors, rng, resamples=resamples))
    p = _two_sided_p(draws.to_numpy(), count)
    corrected = multipletests(p, method="holm")[1]
    return _with_interval(table, draws, count).assign(better_gears=better, gears=count, p=p, p_holm=corrected)


def _with_interval(table: pd.DataFrame, draws: pd.DataFrame, gears: int) -> pd.DataFrame:
    """The table with percentiles of the draws, as order statistics, since a ratio may be infinite."""
    from scipy.stats import norm, t

    tail = norm.sf(np.sqrt(gears / (gears - 1)) * t.isf((1 - LEVEL) / 2, gears - 1))
    values = draws[table.index].to_numpy()
    low = np.quantile(values, tail, axis=0, method="lower")
    high = np.quantile(values, 1 - tail, axis=0, method="higher")
    return table.assign(low=low, high=high)


def _two_sided_p(draws: Float[np.ndarray, "resample method"], gears: int) -> Float[np.ndarray, " method"]:
    """p-values with the widening of the interval; the estimate counts as one more draw, so no p-value is 0."""
    from scipy.stats import norm, t

    beyond = np.minimum((draws <= 0).sum(axis=0), (draws >= 0).sum(axis=0))
    share = np.minimum((1 + beyond) / (1 + len(draws)), 0.5)
    return 2 * t.sf(norm.isf(share) * np.sqrt((gears - 1) / gears), gears - 1)
