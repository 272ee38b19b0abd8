"""Results of the study as tables."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from learn.bootstrap import hierarchical_bootstrap, mean_error
from learn.embedded.proof import Agreement
from learn.embedded.trade import FAITHFUL, Part, Recommendation
from learn.inputs import SPECIMEN
from swgsim.seeds import generator

# C files by what they are for; other names are those of the compiler's libraries.
FEATURES = ("window", "decide", "lines", "residual", "harmonics", "signal", "selection")
CLASSIFIERS = ("dense", "parameters", "perceptron", "convolutional", "forest")
COUNTER = "cortex-m4"  # of instructions; other Cortex-M with single precision take as many


def name_of(entry: Mapping[str, Any]) -> str:
    """A variant's name."""
    return f"{entry['method']}, {entry['numbers']}"


def errors_of(results: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Error [%] of each variant (column) for every specimen of the gears never seen."""
    first = pd.DataFrame(results[0]["specimens"])[list(SPECIMEN)]
    columns = {name_of(entry): np.array(entry["specimens"]["error"]) for entry in results}
    return first.assign(**columns)


def variants_of(results: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """One row for each variant, with sizes and instructions where microcontrollers were there.

    Returns
    -------
    DataFrame
        Indexed by name: ``unseen``, ``low``, ``high`` and ``disturbed`` accuracy [%]; ``…_equal`` of ``…_recordings``
        labels on both data sets, under sanitizers and on each microcontroller, ``same``, the lowest share of them [%],
        and the largest ``difference`` of a probability on gears never seen; ``flash`` and its parts, ``ram`` with
        ``stack`` in it [bytes]; ``instructions`` and its parts.
    """
    errors = errors_of(results)
    accuracy = 100 - hierarchical_bootstrap(errors, mean_error, generator("embedded", 1))
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
    return {**counts, "same": min(100 * each.equal / each.recordings for each in found.values())}


def _cost(entry: Mapping[str, Any]) -> dict[str, Any]:
    flash = pd.Series(entry["flash"])
    features, classifier = (flash.reindex(names).sum() for names in (FEATURES, CLASSIFIERS))
    counts = entry["machines"][COUNTER]["instructions"]
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
    }


def markdown(variants: pd.DataFrame, part: Part, advice: Recommendation | None) -> str:
    """The table and what is recommended, in words."""
    head = ["method and its numbers", "gears never seen [%]", "disturbed [%]",
            "labels as in Python", "disturbed", "probabilities within"]  # fmt: skip
    lines = [[name, *_accuracies(row)] for name, row in variants.iterrows()]
    if "flash" in variants:
        head += ["on a Cortex-M4", "M7", "flash [kB]", "of it classifier", "gear", "RAM [kB]", "instructions [10³]",
                 "of it window", "classifier"]  # fmt: skip
        lines = [line + _costs(row) for line, (_, row) in zip(lines, variants.iterrows(), strict=True)]
    aligned = "|".join([":--", *["--:"] * (len(head) - 1)])
    table = "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)
    return f"| {' | '.join(head)} |\n|{aligned}|\n{table}\n\n{_in_words(variants, part, advice)}\n"


def _accuracies(row: pd.Series) -> list[str]:
    unseen = f"{row['unseen']:.1f} ({row['low']:.1f} to {row['high']:.1f})"
    same = [_of(row, name) for name in ("unseen", "disturbed")]
    return [unseen, f"{row['disturbed']:.1f}", *same, f"{row['difference']:.0e}"]


def _costs(row: pd.Series) -> list[str]:
    flash = [f"{row[name] / 1024:.1f}" for name in ("flash", "flash_classifier", "flash_gear", "ram")]
    counts = [f"{row[name] / 1000:.0f}" for name in ("instructions", "instructions_window", "instructions_classify")]
    return [_of(row, "cortex-m4"), _of(row, "cortex-m7"), *flash, *counts]


def _of(row: pd.Series, name: str) -> str:
    return f"{row[f'{name}_equal']:.0f} of {row[f'{name}_recordings']:.0f}"


def _in_words(variants: pd.DataFrame, part: Part, advice: Recommendation | None) -> str:
    asked = (
        f"{part.flash / 1024:.0f} kB of flash, {part.ram / 1024:.0f} kB of RAM, {part.rate:g} decisions a second and "
        f"{part.instructions / 1e6:g} million instructions a second"
    )
    if "flash" not in variants:
        return "Flash, RAM and instructions need the tools that scripts/install_arm.sh installs."
    out = [name for name in variants.index[~part.fits(variants)]]
    unlike = variants.index[variants["same"] < FAITHFUL]
    left_out = f" These do not fit: {'; '.join(out)}." if out else ""
    left_out += f" Less than {FAITHFUL} % of labels as in Python: {'; '.join(unlike)}." if len(unlike) else ""
    if advice is None:
        return f"None of the methods fits in {asked}."
    row = variants.loc[advice.variant]
    chosen = (
        f"For {asked}: **{advice.variant}**, {row['flash'] / 1024:.1f} kB of flash, {row['ram'] / 1024:.1f} kB of RAM, "
        f"{part.rate * row['instructions'] / 1e6:.1f} million instructions a second."
    )
    if advice.variant == advice.most_accurate:
        return f"{chosen} It is the most accurate of those that fit, and none that is smaller does as well.{left_out}"
    more = (
        f"{advice.difference:.1f} points more ({advice.low:.1f} to {advice.high:.1f}, gears and specimens drawn anew)"
    )
    return (
        f"{chosen} Of those that fit, {advice.most_accurate} is the most accurate; this one errs {more}, which is not "
        f"clearly more, and it is the smallest of which that can be said.{left_out}"
    )
