"""The sections of the report on methods without adaptation: disturbed data, new gears, inputs, splits and size."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from learn.transfer_report import figures, map_figures, size_figures
from learn.transfer_report.input_studies import INPUTS, NETWORKS
from learn.transfer_report.judging_figures import difference_forest
from learn.transfer_report.results import FOREST, ORACLE, ZeroShot, least, row_of
from learn.transfer_report.runs import CLASSIFIERS
from learn.transfer_report.sentences import DISTURBED_GOAL, listed, number, of_row
from learn.transfer_report.studies import best_disturbed
from learn.transfer_report.transfer_page import Section, Table

METHODS: Mapping[str, str] = {short: CLASSIFIERS[name] for name, short in NETWORKS.items()}


def levels(labelled: int) -> list[tuple[str, str]]:
    """The levels of target information with what each means."""
    return [
        ("Z0", "nothing: models see the recording as it is"),
        ("Z1", "healthy acquisitions of the gear, its reference: a commissioning run. The paper assumes as much"),
        ("Z2", "besides, recordings of the gear without labels, of all classes"),
        (
            "Z3",
            "besides, K labelled specimens of each class, the shots; a shot is one specimen at all operating points",
        ),
        (
            "Z4",
            f"besides, all {labelled} labelled specimens of each class; methods of Z3 and Z4 use no recordings without "
            "labels",
        ),
    ]


def left_out(key: str, title: str, commands: str) -> Section:
    """A section whose study was not run."""
    return Section(key, title, [f"Not run. To have it here, run {commands} and make this report again."])


def disturbed(cases: pd.DataFrame, spectrum: pd.DataFrame | None, efficiency_change: float | None) -> Section:
    """Disturbed data solved by representation, and why.

    Parameters
    ----------
    cases : DataFrame
        Of :func:`learn.transfer_report.studies.disturbed_cases`.
    spectrum : DataFrame or None
        ``source``, ``order``, ``amplitude`` of the disturbance and of the faults; None without the clean data set.
    efficiency_change : float or None
        Largest relative change of an efficiency by the disturbance.
    """
    best = best_disturbed(cases)
    lowest = float(row_of(cases, best).min())
    if lowest >= DISTURBED_GOAL:
        solved = (
            f"{best} recognises {lowest:.1f} % and more: a representation is enough for the paper's hardest table, "
            "which is therefore no measure of transfer. The bench below is."
        )
    else:
        solved = f"Our best, {best}, falls to {lowest:.1f} % in one case."
    parts: list = [
        "Accuracy [%] on the gear left out, on the paper's disturbed data (Table X), healthy reference known (Z1). "
        f"{solved[0].upper()}{solved[1:]}",
        Table(
            ["method", *cases.columns], _numbers(cases), "Bold: our best in its worst case.",
            strong=frozenset({list(cases.index).index(best)}),
        ),
    ]  # fmt: skip
    if spectrum is not None and efficiency_change is not None:
        parts += [
            why_disturbance_spares(spectrum, efficiency_change),
            figures.picture(figures.SPECTRUM, map_figures.spectrum(spectrum)),
        ]
    else:
        parts.append("Why, order by order, is shown here when the clean data set of the same grid is there as well.")
    return Section("disturbed", "Disturbed data", parts)


def why_disturbance_spares(spectrum: pd.DataFrame, efficiency_change: float) -> str:
    """Where the disturbance lies beside the faults, from the data sets."""
    table = spectrum.pivot(index="order", columns="source", values="amplitude")
    faults = table.drop(columns="disturbance")
    even = [order for order in table.index if order > 0 and order % 2 == 0]
    noise = 1e3 * table["disturbance"]  # µV/V
    reached = 1e3 * faults.loc[even].max() / noise[even].max()
    above, below = reached.index[reached > 1], reached.index[reached <= 1]
    hidden = f"; that of {listed(below)} does not" if len(below) else ""
    if efficiency_change == 0:
        efficiency = "The efficiency is not disturbed at all, so any change of it is seen."
    else:
        efficiency = f"The efficiency is disturbed by up to {efficiency_change:.1e}, relative."
    return (
        f"Why: eq. 10 adds a mean and the orders 1, 1/2, 1/3 and 1/4. Its mean amplitude is {noise[0]:.2f} µV/V on "
        f"order 0 and {noise[1]:.2f} µV/V on order 1, and at most {noise[even].max():.3f} µV/V on the even orders "
        f"from 2 on. There the largest line of {listed(above)} stands above it{hidden}. {efficiency}"
    )


def _numbers(table: pd.DataFrame) -> list[list[str]]:
    """Rows of a table of figures, the name of each first."""
    named = zip(table.index, table.to_numpy(), strict=True)
    return [[str(name), *(f"{value:.1f}" for value in row)] for name, row in named]


def new_gears(zero: ZeroShot, no_reference: Mapping[str, str]) -> Section:
    """Methods without adaptation on the bench."""
    ordered = zero.table.sort_values("value")
    rows = [
        [
            str(name), of_row(row), of_row(row, "ratio_", 2), of_row(row, "oracle_", 2),
            number(100 - row["development"]) if np.isfinite(row["development"]) else "-",
            number(row["fit_seconds"], digits=0) if np.isfinite(row["fit_seconds"]) else "-",
        ]
        for name, row in ordered.iterrows()
    ]  # fmt: skip
    compared, by_gear = zero.comparison()
    strong = frozenset({list(ordered.index).index(zero.best)})
    parts: list = [
        f"Level Z1: every method is trained on other gears and judged on the same recordings of {zero.gears} gears "
        "never seen, with noise, jitter, measured efficiency and temperature. Intervals hold 95 % and come from "
        f"gears, and specimens within them, drawn anew; they are of one trained model per fold, without the "
        f"scatter of training. The {ORACLE} is Bayes' rule with the gear and all statistics known, with the healthy "
        "scatter taken for Gaussian: what can be had from single recordings, as nearly as we can tell. The second one "
        "is told the bias of the torque flanges of the session, too.",
        Table(
            ["method", "error [%]", "ratio to the paper's forest", "ratio to the oracle", "development gears [%]",
             "fit, all folds [s]"], rows,
            "Bold: the best on the judged gears. Development gears: error of the options that were chosen on them.",
            strong=strong,
        ),
        difference_forest(compared, by_gear, FOREST),
    ]  # fmt: skip
    if no_reference:
        rows = [[name, value] for name, value in no_reference.items()]
        parts.append(Table(["raw signals; efficiency and temperature without and with reference", "error [%]"], rows,
                           "Level Z0 beside Z1, trained on the same recordings, fewer than above."))  # fmt: skip
    return Section("new", "New gears on the bench", parts)


def inputs(table: pd.DataFrame, operating_point: pd.DataFrame | None) -> Section:
    """Raw against differenced against features; the parameters are those of :mod:`.input_studies`, None if not run."""
    facts, errors = table[["input", "method", "efficiency"]], table[["error", "low", "high"]]
    cells = dict(zip(facts.itertuples(index=False, name=None), errors.to_numpy().tolist(), strict=True))
    rows = []
    for kind in INPUTS.values():
        for given in (True, False):
            keys = [(kind, method, given) for method in NETWORKS.values()]
            said = [number(*cells[key]) if key in cells else "-" for key in keys]
            rows.append([kind, "with" if given else "without", *said])
    gain = table.pivot_table(index=["input", "method"], columns="efficiency", values="error")
    worth = (gain[False] - gain[True]).dropna() if {True, False} <= set(gain.columns) else pd.Series(dtype=float)
    parts: list = [
        "Error [%] of networks on gears never seen (Z1); all trained on the same recordings, fewer than above. "
        "Features are all of the paper's together, residuals are signals less the healthy reference, with errors of "
        "load, trigger and speed taken out. Raw and differenced signals see the reference only through efficiency and "
        "temperature: without the efficiency they are nearly at level Z0.",
        Table(["input", "efficiency", *(METHODS[m] for m in NETWORKS.values())], rows, left=2),
    ]
    if len(worth):
        parts.append(
            f"Without the efficiency the error is higher by {worth.min():+.1f} to {worth.max():+.1f} points (mean "
            f"{worth.mean():+.1f})."
        )
    shown = table.assign(method=table["method"].map(METHODS))
    return Section("inputs", "Inputs", [*parts, figures.inputs_map(shown), *_operating_point(operating_point)])


def _operating_point(table: pd.DataFrame | None) -> list:
    """What speed, load and temperature are worth as inputs."""
    if table is None:
        return []
    worse, better = (list(table.index[which]) for which in (table["low"] > 0, table["high"] < 0))
    rows = [[str(name), f"{r['given']:.1f}", f"{r['withheld']:.1f}", of_row(r)] for name, r in table.iterrows()]
    return [
        "Speed, load and temperature as inputs of their own beside the harmonics, which are relative to the healthy "
        "reference at the same operating point: without them the error is clearly higher (points; the whole 95 % "
        f"interval, each by itself) with {listed(worse)}, clearly lower with {listed(better)}.",
        Table(
            ["method", "with operating point [%]", "without [%]", "difference [points]"], rows,
            "The same options and recordings with and without, fewer recordings than in the main comparison; the "
            "difference is paired.",
        ),
    ]  # fmt: skip


def harder(parts: Mapping[str, pd.DataFrame]) -> Section:
    """Splits that leave out severities and operating points."""
    tables = [
        Table([f"{protocol} [%]", *scores.columns],
              _numbers(scores))
        for protocol, scores in parts.items()
    ]  # fmt: skip
    lead = "Accuracy on fault sizes and at operating points that were never trained on; specimens are never shared."
    return Section("harder", "Harder splits", [lead, *tables])


def size(table: pd.DataFrame) -> Section:
    """Size of the forest and of the paper's MLP against robustness."""
    sentences = []
    for classifier, rows in table.groupby("classifier"):
        best, smallest = rows.iloc[int(rows["unseen"].to_numpy().argmax())], least(rows, "gap")
        sentences.append(
            f"{classifier}: highest on an unseen gear with {best['setting']}, size {best['size']} "
            f"({best['unseen']:.1f} %, {best['same']:.1f} % on the same gears); smallest gap with "
            f"{smallest['setting']}, size {smallest['size']} ({smallest['gap']:.1f} points)."
        )
    lines = [[r["classifier"], r["setting"], f"{r['size']}", *(f"{r[c]:.1f}" for c in ("same", "unseen", "gap"))]
            for r in table.to_dict("records")]  # fmt: skip
    header = ["classifier", "setting", "trees or neurons", "same gears [%]", "unseen gear [%]", "gap [points]"]
    return Section(
        "size",
        "Size and robustness",
        [
            " ".join(sentences),
            figures.picture(figures.SIZE, size_figures.against_size(table)),
            Table(header, lines, left=2),
        ],
    )


def made(facts: Sequence[tuple[str, str]]) -> Section:
    """How it was made."""
    return Section("made", "How it was made", [Table(["what", "how"], [list(fact) for fact in facts], left=2)])
