"""The first lines of the report: sentences with the main numbers, correct for any result."""

from collections.abc import Iterable, Mapping

import pandas as pd

from learn.transfer_report.posteriors import FAST_TWIN, FLOOR, TWIN
from learn.transfer_report.studies import DISTURBED_FOREST, PUBLISHED, best_disturbed
from learn.transfer_report.tables import (
    FOREST,
    ORACLE,
    ORACLE_OF_SESSION,
    REZERO,
    best_adapted,
    best_of,
    best_rezeroed,
    highest,
    number,
    row_of,
)

SHOTS = 5  # labelled variants of each class, of which the sentences speak


def listed(names: Iterable[str]) -> str:
    """Names in one line.

    >>> listed(["a", "b", "c"]), listed([])
    ('a, b and c', 'none')
    """
    *first, last = list(names) or ["none"]
    return f"{', '.join(first)} and {last}" if first else last


def of_row(row: Mapping[str, float] | pd.Series) -> str:
    """Value and interval of a row of a table."""
    return number(row["value"], row["low"], row["high"], unit=" %")


def claim(zero: pd.DataFrame, of_units: pd.DataFrame, ratio: pd.Series | None, gears: int, references: int) -> str:
    """What the twin achieves, and under which conditions.

    Parameters
    ----------
    zero, of_units : DataFrame
        Results of :func:`.tables.zero_shot` and :func:`.twins.errors` per unit.
    ratio : Series or None
        Result of :func:`.twins.ratio_to_floor`; None without a floor.
    gears, references : int
        Number of judged gears, and of healthy recordings of each at each operating point.
    """
    floor = ""
    if ratio is not None:
        times = number(ratio["value"], ratio["low"], ratio["high"], digits=2)
        least = of_row(row_of(zero, FLOOR))
        floor = f"; a classifier that knows all parameters but friction errs in {least}: ratio {times}"
    return (
        f"{references} healthy recordings at each operating point identify a gear, and its twin names faults that "
        f"nobody has recorded, without any training gear or label: it errs in {of_row(row_of(zero, TWIN))} of the "
        f"recordings and {of_row(row_of(of_units, TWIN))} of the units{floor}. Conditions: {gears} simulated gears "
        "never seen, on a bench with errors; the twin believes the bench and the sizes of faults with which they were "
        "recorded."
    )


def in_session(session: pd.Series | None, healthy: int) -> list[str]:
    """What healthy specimens of the session are worth to the twin; none if it was not asked.

    Parameters
    ----------
    session : Series or None
        Result of :func:`.twins.in_session`.
    healthy : int
        Number of specimens.
    """
    if session is None:
        return []
    of_unit = number(session["unit"], session["unit_low"], session["unit_high"], unit=" %")
    return [
        f"Given {healthy} healthy specimens of the session at each operating point as well, the twin errs in "
        f"{of_row(session)} of the recordings and {of_unit} of the units."
    ]


def fast_twin(zero: pd.DataFrame, methods: pd.DataFrame) -> list[str]:
    """What the network achieves that is given the references; none if it was not run.

    Parameters
    ----------
    zero : DataFrame
        Result of :func:`.tables.zero_shot`.
    methods : DataFrame
        Run of every method, with its metrics.
    """
    if FAST_TWIN not in zero.index:
        return []
    time = number(row_of(methods, FAST_TWIN)["milliseconds"], digits=2, unit=" ms")
    return [
        "The fast twin, one network that is given the references of the judged gear and was trained on other gears of "
        f"its series, errs in {of_row(row_of(zero, FAST_TWIN))} of the recordings and takes {time} for each."
    ]


def headline(zero: pd.DataFrame, gears: int) -> str:
    """The best method that learns from other gears, the paper's forest and the oracle."""
    best = best_of(zero.drop(index=[TWIN, FAST_TWIN], errors="ignore"))
    ours, forest, oracle = (of_row(row_of(zero, name)) for name in (best, FOREST, ORACLE))
    return (
        f"On bench recordings of {gears} gears never seen, with their healthy references known, {best} errs in {ours} "
        "of the recordings after training on other gears. "
        f"The paper's forest errs in {forest}, and the oracle, which knows the gear, in {oracle}."
    )


def lead(
    zero: pd.DataFrame,
    few: pd.DataFrame,
    gears: Mapping[str, pd.DataFrame],
    development: pd.Series,
    cases: pd.DataFrame,
) -> list[str]:
    """Sentences after the first: choice of the method, shots, disturbed data.

    Parameters
    ----------
    zero : DataFrame
        Result of :func:`.tables.zero_shot`.
    few : DataFrame
        Result of :func:`.tables.few_shot`.
    gears : mapping
        Adapted method to its errors of gears.
    development : Series
        Score of each adapted method on development gears [%].
    cases : DataFrame
        Result of :func:`.studies.disturbed_cases`.
    """
    parts = (
        choice(zero),
        rezeroed(few),
        with_shots(zero, few, development),
        beside_rezero(few, gears),
        disturbed(cases),
    )
    return [part for part in parts if part]


def choice(zero: pd.DataFrame) -> str:
    """The method that the development gears choose, of those that learn; empty if no method has options."""
    best, chosen = best_of(zero.drop(index=[TWIN, FAST_TWIN], errors="ignore")), highest(zero["development"])
    if not chosen:
        return ""
    more = row_of(zero, chosen)["value"] - row_of(zero, best)["value"]
    same = "the same method" if chosen == best else f"{more:.1f} points more"
    return (
        "The best method that learns is selected on the judged gears, which favours it slightly. The development "
        f"gears, which are never judged, select {chosen} with {row_of(zero, chosen)['value']:.1f} %, {same}."
    )


def rezeroed(few: pd.DataFrame) -> str:
    """What healthy recordings of the session are worth, without any fault; empty if it was not measured."""
    rows = best_rezeroed(few)
    texts = [f"with {k}, {row['method'].removesuffix(REZERO)} errs in {of_row(row)}" for k, row in rows.items() if k]
    if not texts:
        return ""
    return (
        "Healthy recordings of the session at each operating point show the zeros of the torque flanges, without any "
        f"recorded fault: {listed(texts)}."
    )


def with_shots(zero: pd.DataFrame, few: pd.DataFrame, development: pd.Series) -> str:
    """Best transfer with five shots against no label at all, and its choice; empty if it was not run."""
    best = best_adapted(few, SHOTS)
    if best is None:
        return ""
    plain, here = best_of(zero), few[few["shots"] == SHOTS].set_index("method")
    below = "below" if best["value"] < row_of(zero, plain)["value"] else "not below"
    text = (
        f"With {SHOTS} labelled variants of each class, {best['method']} errs in {of_row(best)}, {below} the "
        f"{row_of(zero, plain)['value']:.1f} % of {plain} without labels. The oracle with the same knowledge of the "
        f"session errs in {row_of(zero, ORACLE_OF_SESSION)['value']:.1f} %."
    )
    chosen = highest(development[development.index.isin(here.index)])
    if chosen:
        text += f" The development gears select {chosen}: {of_row(row_of(here, chosen))}."
    return text


def beside_rezero(few: pd.DataFrame, gears: Mapping[str, pd.DataFrame]) -> str:
    """For how many gears labelled faults are worth more than as many healthy specimens; empty if one was not run."""
    adapted, rezero = best_adapted(few, SHOTS), best_rezeroed(few).get(SHOTS)
    if adapted is None or rezero is None:
        return ""
    tables = (gears[row["method"]] for row in (adapted, rezero))
    with_faults, healthy = (table[table["shots"] == SHOTS].set_index("gear")["error"] for table in tables)
    return (
        f"For {(with_faults < healthy).sum()} of {len(healthy)} gears {adapted['method']} with {SHOTS} labelled "
        f"variants of each class errs less than {rezero['method'].removesuffix(REZERO)} with {SHOTS} healthy ones "
        "alone."
    )


def disturbed(cases: pd.DataFrame) -> str:
    """Accuracies on the paper's disturbed data."""
    best = best_disturbed(cases)
    ours, forest, paper = (
        " / ".join(f"{value:.1f}" for value in row_of(cases, name)) for name in (best, DISTURBED_FOREST, PUBLISHED)
    )
    return (
        f"On the paper's disturbed data (Table X), {best} recognises {ours} % on the gear left out; the paper's forest "
        f"recognises {paper} % in the paper and {forest} % here."
    )
