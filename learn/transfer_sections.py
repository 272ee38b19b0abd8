"""The sections of the report that compare methods: disturbed data, new gears, inputs, transfer, and where it pays."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from learn import transfer_figures as figures
from learn.judging_figures import difference_forest
from learn.transfer_page import Section, Table
from learn.transfer_results import FOREST, ORACLE, ZeroShot, best_adapted
from learn.transfer_sentences import DISTURBED_GOAL, FORGETTING_GOAL, listed, number, of_row
from learn.transfer_studies import INPUTS, NETWORKS, best_disturbed

METHODS: Mapping[str, str] = {"mlp": "MLP", "cnn": "CNN", "minirocket": "MiniRocket"}


def levels(labelled: int | None) -> list[tuple[str, str]]:
    """The levels of target information with what each means."""
    pool = f"all {labelled} labelled specimens" if labelled else "all labelled specimens"
    return [
        ("Z0", "nothing: models see the recording as it is"),
        ("Z1", "healthy acquisitions of the gear, its reference: a commissioning run. The paper assumes as much"),
        ("Z2", "besides, recordings of the gear without labels, of all classes"),
        (
            "Z3",
            "besides, K labelled specimens of each class, the shots; a shot is one specimen at all operating points",
        ),
        ("Z4", f"besides, {pool} of each class: what labels of the gear can give at most"),
    ]


def left_out(key: str, title: str, commands: str) -> Section:
    """A section whose study was not run."""
    return Section(key, title, [f"Not run. To have it here, run {commands} and make this report again."])


def disturbed(cases: pd.DataFrame, spectrum: pd.DataFrame | None, efficiency_change: float | None) -> Section:
    """Disturbed data solved by representation, and why.

    Parameters
    ----------
    cases : DataFrame
        Of :func:`learn.transfer_studies.disturbed_cases`.
    spectrum : DataFrame or None
        ``source``, ``order``, ``amplitude`` of the disturbance and of the faults; None without the clean data set.
    efficiency_change : float or None
        Largest relative change of an efficiency by the disturbance.
    """
    best = best_disturbed(cases)
    numbers = [
        [name, *(f"{value:.1f}" for value in row)] for name, row in zip(cases.index, cases.to_numpy(), strict=True)
    ]
    held = bool((cases.loc[best] >= DISTURBED_GOAL).all())
    solved = "solves" if held else "does not quite solve"
    parts: list = [
        f"Accuracy [%] on the gear left out, the paper's disturbed data (Table X), healthy reference known (Z1). {best} "
        f"{solved} the paper's hardest table, so this table measures the representation and is no measure of transfer; "
        "the honest one is the bench below.",
        Table(
            ["method", *cases.columns], numbers, "Bold: our best in its worst case.",
            strong=frozenset({list(cases.index).index(best)}),
        ),
    ]  # fmt: skip
    if spectrum is not None and efficiency_change is not None:
        parts += [why_disturbance_spares(spectrum, efficiency_change), figures.order_spectrum(spectrum)]
    return Section("disturbed", "Disturbed data", parts)


def why_disturbance_spares(spectrum: pd.DataFrame, efficiency_change: float) -> str:
    """Where the disturbance lies beside the faults, from the data sets."""
    table = spectrum.pivot(index="order", columns="source", values="amplitude")
    faults = table.drop(columns="disturbance")
    even = [order for order in table.index if order > 0 and order % 2 == 0]
    noise = 1e3 * table["disturbance"]  # µV/V
    reached = 1e3 * faults.loc[even].max(axis="rows") / noise[even].max()
    above, below = reached.index[reached > 1], reached.index[reached <= 1]
    hidden = f"; that of {listed(below)} does not" if len(below) else ""
    if efficiency_change == 0:
        efficiency = "The efficiency is not disturbed at all, so any change of it is seen."
    else:
        efficiency = f"The efficiency is disturbed by up to {efficiency_change:.1e}, relative."
    return (
        f"Why: eq. 10 adds a mean and the orders 1, 1/2, 1/3 and 1/4. Its mean amplitude is {noise[0]:.2f} µV/V on order "
        f"0 and {noise[1]:.2f} µV/V on order 1, and at most {noise[even].max():.3f} µV/V on the even orders from 2 on. "
        f"There the largest line of {listed(above)} stands above it{hidden}. {efficiency}"
    )


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
        f"Level Z1: every method is trained on other gears and judged on the same recordings of {zero.gears} gears never "
        "seen, with noise, jitter, measured efficiency and temperature. Intervals hold 95 % and come from gears, and "
        f"specimens within them, drawn anew. The {ORACLE} knows the gear and all statistics: no classifier of single "
        "recordings errs less on average; the second one is told the bias of the torque flanges of the session, too.",
        Table(
            ["method", "error [%]", "ratio to the paper's forest", "ratio to the oracle", "error on development gears [%]",
             "fit, all folds [s]"], rows, "Bold: the best on the judged gears.", strong=strong,
        ),
        difference_forest(compared, by_gear, FOREST),
    ]  # fmt: skip
    if no_reference:
        rows = [[name, value] for name, value in no_reference.items()]
        parts.append(Table(["raw signals without and with the reference", "error [%]"], rows,
                           "Level Z0 beside Z1, trained on the same recordings, fewer than above."))  # fmt: skip
    return Section("new", "New gears on the bench", parts)


def inputs(table: pd.DataFrame) -> Section:
    """Raw against differenced against features."""
    cells = table.set_index(["input", "method", "efficiency"]).sort_index()
    rows = []
    for kind in INPUTS.values():
        for given in (True, False):
            found = [cells.loc[key] if (key := (kind, m, given)) in cells.index else None for m in NETWORKS.values()]
            said = [number(c["error"], c["low"], c["high"]) if c is not None else "-" for c in found]
            rows.append([kind, "with" if given else "without", *said])
    gain = table.pivot_table(index=["input", "method"], columns="efficiency", values="error")
    worth = (gain[False] - gain[True]).dropna() if {True, False} <= set(gain.columns) else pd.Series(dtype=float)
    parts: list = [
        "Level Z1, error [%] of networks on gears never seen; all trained on the same recordings, ten variants of each "
        "class and source gear. Features are all of the paper's together; residuals are signals less the healthy "
        "reference, with errors of load and trigger taken out.",
        Table(["input", "efficiency", *(METHODS[m] for m in NETWORKS.values())], rows, left=2),
    ]
    if len(worth):
        parts.append(
            f"Without the efficiency the error is higher by {worth.min():+.1f} to {worth.max():+.1f} points "
            f"(mean {worth.mean():+.1f})."
        )
    shown = table.assign(method=table["method"].map(METHODS))
    return Section("inputs", "Inputs", [*parts, figures.inputs_map(shown)])


def transfer(zero: ZeroShot, few: pd.DataFrame, forgotten: pd.DataFrame, draws: str) -> Section:
    """Error against shots, per method, and what is forgotten."""
    curves = few[few["shots"] > 0].rename(columns={"value": "error"})
    shots = sorted(few["shots"].unique())
    level = {
        "paper's forest": float(zero.table.loc[FOREST, "value"]),
        "best without adaptation": float(zero.table.loc[zero.best, "value"]),
        "oracle": float(zero.table.loc[ORACLE, "value"]),
    }
    said = few.assign(text=[of_row(row) for _, row in few.iterrows()])
    wide = said.pivot(index="method", columns="shots", values="text").fillna("-")
    unadapted = few.groupby("method")["unadapted"].first()
    wide = wide.loc[few.groupby("method")["value"].min().sort_values().index]
    rows = [[str(m), f"{unadapted[m]:.1f}", *wide.loc[m]] for m in wide.index]
    parts: list = [
        f"Levels Z2 to Z4 on the bench. Every method starts from a model that was trained on the source gears; its options "
        f"were chosen on development gears. Errors are means over {draws} draws of the shots, the same for all methods.",
    ]
    if len(curves):
        parts.append(figures.error_against_shots(curves, level))
    columns = ["Z2, no label" if k == 0 else f"K = {k}{' (Z4)' if k == shots[-1] else ''}" for k in shots]
    parts.append(Table(["method", "source model", *columns], rows, "Error [%] with its 95 % interval."))
    with_labels = [k for k in shots if k > 0]
    ratio = [[f"K = {k}", str(b["method"]), of_row(b), of_row(b, "ratio_", 2), of_row(b, "gain_")]
             for k in with_labels if (b := best_adapted(few, int(k))) is not None]  # fmt: skip
    parts.append(Table(["shots", "best transfer", "error [%]", "ratio to the paper's forest",
                        "change to its source model [points]"], ratio, left=2))  # fmt: skip
    parts += _forgetting(forgotten)
    return Section("transfer", "Transfer", parts)


def _forgetting(forgotten: pd.DataFrame) -> list:
    """Table and picture of the accuracy lost on source gears."""
    kept = forgotten.dropna(subset=["forgotten"])
    if kept.empty:
        return ["What adapting forgets was not measured: the protocol keeps no variant of the source gears out."]
    wide = kept.pivot(index="method", columns="shots", values="forgotten")
    worst = kept.groupby("method")["worst"].max()
    rows = [
        [str(m), *("-" if np.isnan(v) else f"{v:+.1f}" for v in wide.loc[m]), f"{worst[m]:+.1f}"] for m in wide.index
    ]
    header = ["method", *("Z2" if k == 0 else f"K = {k}" for k in wide.columns), "worst gear"]
    note = (
        f"Accuracy lost on variants of the source gears that no model was trained on [points], mean over the judged gears; "
        f"the goal is {FORGETTING_GOAL:g}. A gear of its own may keep the source model beside the adapted one."
    )
    with_labels = kept[kept["shots"] > 0]
    return [Table(header, rows, note), *([figures.forgotten_against_shots(with_labels)] if len(with_labels) else [])]


def where_it_pays(table: pd.DataFrame) -> Section:
    """The map of scenarios."""
    rows = [
        [r["scenario"], r["method"], f"{r['shots']}", f"{r['unadapted']:.1f}", f"{r['error']:.1f}",
         number(r["gain"], r["low"], r["high"]), _verdict(r["low"], r["high"])]
        for r in table.to_dict("records")
    ]  # fmt: skip
    transferred = table[~table["method"].str.endswith(": from scratch")]
    pays = transferred["high"] < 0
    parts = [
        f"Transfer pays clearly in {int(pays.sum())} of {len(transferred)} cases (a scenario and a number of shots): there "
        "the whole interval of the change that adapting makes to the source model lies below 0.",
        figures.where_transfer_pays(table),
        Table(["scenario", "method", "K", "source model [%]", "adapted [%]", "change [points]", "pays"], rows, left=2),
    ]
    return Section("map", "Where transfer pays", parts)


def _verdict(low: float, high: float) -> str:
    """Whether adapting helps, from the interval of the change."""
    if not np.isfinite(high):
        return "too few gears"
    return "yes" if high < 0 else "harms" if low > 0 else "not clearly"


def harder(parts: Mapping[str, pd.DataFrame]) -> Section:
    """Splits that leave out severities and operating points."""
    tables = [
        Table([f"{protocol} [%]", *scores.columns],
              [[str(name), *(f"{value:.1f}" for value in row)] for name, row in zip(scores.index, scores.to_numpy(), strict=True)])
        for protocol, scores in parts.items()
    ]  # fmt: skip
    lead = "Accuracy on fault sizes and at operating points that were never trained on; specimens are never shared."
    return Section("harder", "Harder splits", [lead, *tables])


def size(table: pd.DataFrame) -> Section:
    """Size of the forest and of the paper's MLP against robustness."""
    sentences = []
    for classifier, rows in table.groupby("classifier"):
        best = rows.loc[rows["unseen"].idxmax()]
        least = rows.loc[rows["gap"].idxmin()]
        sentences.append(
            f"{classifier}: highest on an unseen gear with {best['setting']}, size {best['size']} ({best['unseen']:.1f} %, "
            f"{best['same']:.1f} % on the same gears); smallest gap with {least['setting']}, size {least['size']} "
            f"({least['gap']:.1f} points)."
        )
    rows = [[r["classifier"], r["setting"], f"{r['size']}", *(f"{r[c]:.1f}" for c in ("same", "unseen", "gap"))]
            for r in table.to_dict("records")]  # fmt: skip
    header = ["classifier", "setting", "trees or neurons", "same gears [%]", "unseen gear [%]", "gap [points]"]
    return Section(
        "size",
        "Size and robustness",
        [" ".join(sentences), figures.robustness_against_size(table), Table(header, rows, left=2)],
    )


def made(facts: Sequence[tuple[str, str]]) -> Section:
    """How it was made."""
    return Section("made", "How it was made", [Table(["what", "how"], [list(fact) for fact in facts], left=2)])
