"""The content of ``transfer.json``."""

from typing import Any

import pandas as pd

from learn.transfer_report import studies
from learn.transfer_report.tables import (
    FOREST,
    ORACLE,
    ORACLE_OF_SESSION,
    best_adapted,
    best_of,
    best_rezeroed,
    both_in_json,
    finite,
    highest,
    in_json,
    row_of,
)

SHOTS = (1, 2, 5)


def content(
    zero: pd.DataFrame,
    of_units: pd.DataFrame,
    few: pd.DataFrame,
    cases: pd.DataFrame,
    gears: int,
    seconds: float,
) -> dict[str, Any]:
    """Content of ``transfer.json``: errors and accuracies [%]; None for an unknown number."""
    best, chosen, solved = best_of(zero), highest(zero["development"]), studies.best_disturbed(cases)
    adapted = {shots: row for shots in SHOTS if (row := best_adapted(few, shots)) is not None}
    return {
        "z1": {
            "forest_error": finite(row_of(zero, FOREST)["value"]),
            "best_method": best,
            "best_error": finite(row_of(zero, best)["value"]),
            "ratio": finite(row_of(zero, best)["ratio"]),
            "ci95": [finite(row_of(zero, best)["ratio_low"]), finite(row_of(zero, best)["ratio_high"])],
            "ratio_to_oracle": finite(row_of(zero, best)["oracle"]),
            "seeds": int(row_of(zero, best)["seeds"]),
            "spread_over_seeds": finite(row_of(zero, best)["spread"]),
            "chosen_on_development_gears": chosen,
            "chosen_error": finite(row_of(zero, chosen)["value"]) if chosen else None,
        },
        "z3": {
            str(shots): {
                "best_method": row["method"],
                "best_error": finite(row["value"]),
                "ratio_to_forest": finite(row["ratio"]),
                "ci95": [finite(row["ratio_low"]), finite(row["ratio_high"])],
            }
            for shots, row in adapted.items()
        },
        "rezero": {str(shots): both_in_json(row) for shots, row in best_rezeroed(few).items()},
        "unit": {name: in_json(row_of(of_units, name)) for name in of_units.index},
        "oracle_error": finite(row_of(zero, ORACLE)["value"]),
        "oracle_session_error": finite(row_of(zero, ORACLE_OF_SESSION)["value"]),
        "gears": gears,
        "disturbed": {
            "z1": row_of(cases, solved).round(3).tolist(),
            "z1_method": solved,
            "forest_paper": row_of(cases, studies.DISTURBED_FOREST).round(3).tolist(),
            "forest_in_the_paper": cases.iloc[0].round(3).tolist(),
        },
        "seconds": round(seconds, 1),
    }
