"""The sections of the report on adapting to a gear: error against shots, what is forgotten, and where it pays."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from learn.transfer_report import curve_figures, figures
from learn.transfer_report.results import FOREST, FROM_SCRATCH, ORACLE_OF_SESSION, ZeroShot, best_adapted, figure
from learn.transfer_report.sentences import FORGETTING_GOAL, number, of_row
from learn.transfer_report.transfer_page import Section, Table


def transfer(
    zero: ZeroShot, few: pd.DataFrame, forgotten: pd.DataFrame, draws: str, labelled: int, variants: Mapping[str, str]
) -> Section:
    """Error against shots, per method, and what is forgotten; `variants` of methods whose source model had few."""
    curves = few[few["shots"] > 0].rename(columns={"value": "error"})
    shots = sorted(few["shots"].unique())
    level = {
        "paper's forest": figure(zero.table, FOREST),
        "best without adaptation": figure(zero.table, zero.best),
        ORACLE_OF_SESSION: figure(zero.table, ORACLE_OF_SESSION),
    }
    said = few.assign(text=[of_row(row) for _, row in few.iterrows()])
    wide = said.pivot(index="method", columns="shots", values="text").fillna("-")
    unadapted = few.groupby("method")["unadapted"].first()
    wide = wide.loc[few.groupby("method")["value"].min().sort_values().index]
    few_variants = {name: f" (trained on {number} variants)" for name, number in variants.items()}
    rows = [[f"{m}{few_variants.get(str(m), '')}", f"{unadapted[m]:.1f}", *wide.loc[m]] for m in wide.index]
    parts: list = [
        "Levels Z2 to Z4 on the bench. Every method but from scratch starts from a model that was trained on the "
        "source gears; options were chosen on development gears. Shots are of the same session as the recordings that "
        "are judged, so they also tell the bias of its torque flanges: the oracle to compare with is the one that "
        f"knows it. Errors are means over {draws} draws of the shots, the same for all methods, of one trained model "
        "per fold.",
    ]
    if len(curves):
        parts.append(figures.picture(figures.SHOTS, curve_figures.error(curves, level)))
    names = {k: "Z2, no label" if k == 0 else f"K = {k}{' (Z4)' if k == labelled else ''}" for k in shots}
    parts.append(Table(["method", "source model", *names.values()], rows, "Error [%] with its 95 % interval."))
    ratio = [[names[k], str(b["method"]), of_row(b), of_row(b, "ratio_", 2), of_row(b, "gain_")]
             for k in shots if k > 0 and (b := best_adapted(few, int(k))) is not None]  # fmt: skip
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
        "Accuracy lost on variants of the source gears that no model was trained on [points], mean over the judged "
        f"gears; the goal is {FORGETTING_GOAL:g}. A gear of its own may keep the source model beside the adapted one."
    )
    with_labels = kept[kept["shots"] > 0]
    return [Table(header, rows, note), *([figures.forgotten_against_shots(with_labels)] if len(with_labels) else [])]


def where_it_pays(table: pd.DataFrame, draws: str) -> Section:
    """The map of scenarios."""
    rows = [
        [r["scenario"], r["method"], f"{r['shots']}", f"{r['unadapted']:.1f}", f"{r['error']:.1f}",
         number(r["gain"], r["low"], r["high"]), _verdict(r["method"], r["low"], r["high"]),
         f"{r['best']}: {number(r['best_gain'], r['best_low'], r['best_high'])}" if r["best"] else "-"]
        for r in table.to_dict("records")
    ]  # fmt: skip
    transferred = table[~table["method"].str.endswith(FROM_SCRATCH)]
    pays = transferred["high"] < 0
    parts: list = [
        f"Adapting pays in {int(pays.sum())} of {len(transferred)} cases (a scenario and a number of shots): there the "
        "whole 95 % interval of the change that adapting makes to its source model lies below 0. Each interval stands "
        "alone: of cases without any effect, one in forty would lie below 0 by chance. Draws of the shots for each "
        f"gear: {draws}. From scratch is what the shots give without any source gear.",
        _beside_the_best(transferred),
        figures.where_transfer_pays(table),
        Table(["scenario", "method", "K", "source model [%]", "adapted [%]", "change [points]", "pays",
               "beside the best without adaptation, chosen on the judged gears [points]"], rows, left=2),
    ]  # fmt: skip
    return Section("map", "Where transfer pays", parts)


def _beside_the_best(table: pd.DataFrame) -> str:
    """Whether adapting also beats the best method without it, at the same place."""
    compared = table[table["best"] != ""]
    if compared.empty:
        return (
            "Another method may need no label to be as good: the best method without adaptation was not run with the "
            "same source gears, references and targets, and is not compared here. Add methods with 'python "
            "scripts/train.py experiment=transfer_map adaptation=none classifier=extra_trees' and so on."
        )
    better, worse = int((compared["best_high"] < 0).sum()), int((compared["best_low"] > 0).sum())
    rest = len(table) - len(compared)
    return (
        f"Beside the best method without adaptation at the same place, adapting is clearly better in {better} of "
        f"{len(compared)} cases and clearly worse in {worse}"
        + (f"; {rest} cases have no such method and are not compared." if rest else ".")
    )


def _verdict(method: str, low: float, high: float) -> str:
    """Whether transfer helps, from the interval of the change."""
    if method.endswith(FROM_SCRATCH):
        return "-"
    if not np.isfinite(high):
        return "too few gears"
    return "yes" if high < 0 else "harms" if low > 0 else "not clearly"
