"""Table of the paper's disturbed data."""

import pandas as pd

from learn.evaluation.evaluate import metric_key
from learn.paper.published_tables import paper_table
from learn.transfer_report.runs import by_method

DISTURBED_FOREST = "random forest on Selection 3"  # the paper's best in Table X
PUBLISHED = "the paper's own figures"


def disturbed_cases(runs: pd.DataFrame) -> pd.DataFrame:
    """Accuracy in the three cases of Table X (columns) of every method (rows), the paper's own figures first [%].

    Raises
    ------
    ValueError
        If the paper's forest was not run.
    """
    paper = paper_table("table10").query("classifier == 'rf' and features == 'selection_3'")
    cases = list(paper["row"])
    ours = by_method(runs)[[f"test/{metric_key(case)}" for case in cases]].set_axis(cases, axis="columns")
    if DISTURBED_FOREST not in ours.index:
        raise ValueError(
            f"no run of the {DISTURBED_FOREST} on the disturbed data: add classifier=rf features=selection_3"
        )
    theirs = pd.DataFrame([paper["paper"].to_numpy()], index=[PUBLISHED], columns=cases)
    return pd.concat([theirs, ours.astype(float)]).rename_axis("method")


def best_disturbed(cases: pd.DataFrame) -> str:
    """Our method with the highest accuracy in its worst case."""
    return str(cases.iloc[1:].min(axis="columns").idxmax())
