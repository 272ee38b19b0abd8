"""The studies beside the main comparison as tables: disturbed data, splits, and size."""

from collections.abc import Mapping

import pandas as pd

from learn.evaluation.evaluate import metric_key
from learn.paper.published_tables import paper_table
from learn.transfer_report.runs import CLASSIFIERS, by_method
from swgsim.common.style import words

PAPER_FOREST = "random forest on Selection 3"  # the paper's best in Table X
# Size, along the axis, and what tells lines apart, of the paper's two classifiers whose robustness it asks about.
SIZES: Mapping[str, tuple[str, str]] = {
    "rf": ("classifier.trees", "classifier.depth"),
    "mlp": ("classifier.neurons", "classifier.hidden_layers"),
}


def disturbed_cases(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy of every method (rows) in the three cases of Table X (columns), and of the paper's forest [%].

    Raises
    ------
    ValueError
        If the paper's forest was not run.
    """
    paper = paper_table("table10").query("classifier == 'rf' and features == 'selection_3'")
    cases = list(paper["row"])
    ours = by_method(runs)[[f"test/{metric_key(case)}" for case in cases]].set_axis(cases, axis="columns")
    if PAPER_FOREST not in ours.index:
        raise ValueError(f"no run of the {PAPER_FOREST} on the disturbed data: add classifier=rf features=selection_3")
    theirs = pd.DataFrame([paper["paper"].to_numpy()], index=["the paper's own figures"], columns=cases)
    return pd.concat([theirs, ours.astype(float)])


def best_disturbed(cases: pd.DataFrame) -> str:
    """Our method with the highest accuracy in its worst case."""
    return str(cases.iloc[1:].min(axis="columns").idxmax())


def robustness(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy on the same gears and on an unseen one against size.

    Returns
    -------
    DataFrame
        ``classifier``, ``setting`` (text), ``size``, ``same`` and ``unseen`` [%], ``gap`` [points].
    """
    parts = []
    for classifier, of_kind in runs.groupby("classifier"):
        size, setting = SIZES[str(classifier)]
        scores = of_kind.drop_duplicates(["protocol", size, setting])
        scores = scores.pivot(index=[setting, size], columns="protocol", values="test_score").reset_index()
        noun = setting.split(".")[1].replace("_", " ")
        parts.append(
            pd.DataFrame(
                {
                    "classifier": CLASSIFIERS[str(classifier)],
                    "setting": noun + " " + scores[setting],
                    "size": scores[size].astype(int),
                    "same": scores["grouped_folds"].astype(float),
                    "unseen": scores["leave_one_gear_out"].astype(float),
                }
            )
        )
    table = pd.concat(parts, ignore_index=True)
    table["order"] = table["setting"].str.split().str[-1].astype(int)
    table = table.sort_values(["classifier", "order", "size"], ignore_index=True).drop(columns="order")
    return table.assign(gap=table["same"] - table["unseen"])


def harder_splits(runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Per protocol the accuracy of every method (rows) on every split, and their mean (columns) [%]."""
    parts = {}
    for protocol, of_protocol in runs.groupby("protocol"):
        scores = by_method(of_protocol).filter(regex="^test/").astype(float).dropna(axis="columns", how="all")
        scores.columns = [str(name).removeprefix("test/").replace("_", " ") for name in scores]
        parts[words(str(protocol))] = scores.assign(mean=scores.mean(axis="columns"))
    return parts
