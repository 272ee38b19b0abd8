"""Results of the study as tables."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from learn.embedded.proof import Agreement
from learn.evaluation.bootstrap import gear_bootstrap, mean_error
from learn.inputs.inputs import SPECIMEN
from swgsim.common.seeds import generator

# C files by purpose; other names are libraries of the compiler.
FEATURES = ("window", "decide", "lines", "residual", "harmonics", "signal", "selection")
CLASSIFIERS = ("dense", "parameters", "perceptron", "convolutional", "forest")
COUNTER = "cortex-m4"  # of instructions; other Cortex-M with single precision take as many


def name_of(entry: Mapping[str, Any]) -> str:
    """A variant's name."""
    return f"{entry['method']}, {entry['numbers']}"


def errors_of(results: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Error [%] of each variant (column) for every specimen of the unseen gears."""
    first = pd.DataFrame(results[0]["specimens"])[list(SPECIMEN)]
    columns = {name_of(entry): np.array(entry["specimens"]["error"]) for entry in results}
    return first.assign(**columns)


def variants_of(results: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """One row for each variant, with sizes and instructions if there are microcontrollers.

    Returns
    -------
    DataFrame
        Indexed by name: ``unseen``, ``low``, ``high`` and ``disturbed`` accuracy [%]; ``…_equal`` of ``…_recordings``
        labels on both data sets, under sanitizers and on each microcontroller, ``same``, the lowest share of them [%],
        and the largest ``difference`` of a probability on unseen gears; ``flash`` and its parts, ``ram`` with
        ``stack`` in it [bytes]; ``instructions`` of a decision and their parts, the ``most_instructions`` of one, and
        those of the ``longest_push``.
    """
    errors = errors_of(results)
    accuracy = 100 - gear_bootstrap(errors, mean_error, generator("embedded", 1))
    rows = {}
    for entry in results:
        of_gears = accuracy.loc[name_of(entry)]
        row = {
            "unseen": of_gears["value"],
            "low": of_gears["high"],
            "high": of_gears["low"],
            "disturbed": entry["disturbed"],
            "difference": entry["host"]["unseen"]["difference"],
        }
        rows[name_of(entry)] = row | _agreement(entry) | (_cost(entry) if entry["machines"] else {})
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("variant")


def _agreement(entry: Mapping[str, Any]) -> dict[str, Any]:
    of_machines = {name: machine["agreement"] for name, machine in entry["machines"].items()}
    every = {**entry["host"], "sanitized": entry["sanitized"], **of_machines}
    found = {name: Agreement(**each) for name, each in every.items()}
    counts = {f"{name}_equal": each.equal for name, each in found.items()}
    counts |= {f"{name}_recordings": each.recordings for name, each in found.items()}
    return {**counts, "same": min(each.share for each in found.values())}


def _cost(entry: Mapping[str, Any]) -> dict[str, Any]:
    flash = pd.Series(entry["flash"])
    features, classifier = (flash.reindex(names).sum() for names in (FEATURES, CLASSIFIERS))
    counter = entry["machines"][COUNTER]
    counts = counter["instructions"]
    stack = max(machine["stack"] for machine in entry["machines"].values())
    return {
        "flash": int(flash.sum()),
        "flash_features": int(features),
        "flash_classifier": int(classifier),
        "flash_gear": int(flash["gear"]),
        "flash_library": int(flash.sum() - features - classifier - flash["gear"]),
        "ram": entry["ram"] + stack,
        "stack": stack,
        "instructions": counts["window"] + counts["decide"],
        "instructions_window": counts["window"],
        "instructions_features": counts["features"],
        "instructions_classify": counts["classify"],
        "most_instructions": counter["most_instructions"],
        "longest_push": counter["longest_push"],
    }
