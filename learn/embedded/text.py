"""The study as text: two tables and a recommendation."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from learn.embedded.proof import FAITHFUL
from learn.embedded.trade import Part, Recommendation

ACCURACY = (
    "method and its numbers", "unseen gears [%]", "disturbed [%]", "labels as in Python, unseen gears",
    "disturbed", "probabilities within",
)  # fmt: skip
MACHINES = ("Cortex-M4", "Cortex-M7", "sanitizers")
COST = (
    "method and its numbers", "flash [kB]", "of it features", "classifier", "gear", "RAM [kB]", "of it stack",
    "instructions [10³]", "of it window", "features", "classifier", "a sample at most [10³]",
)  # fmt: skip
BYTES = ("flash", "flash_features", "flash_classifier", "flash_gear", "ram", "stack")
COUNTS = (
    "instructions", "instructions_window", "instructions_features", "instructions_classify",
)  # fmt: skip


def markdown(variants: pd.DataFrame, part: Part, advice: Recommendation | None) -> str:
    """Tables of accuracy and of cost, and a recommendation.

    Parameters
    ----------
    variants : DataFrame
        Of :func:`learn.embedded.table.variants_of`.
    part : Part
    advice : Recommendation or None
    """
    if "flash" not in variants:
        accuracy = _table(ACCURACY, [_accuracy(row) for _, row in variants.iterrows()])
        return f"{accuracy}\nFlash, RAM and instructions need the tools that scripts/install_arm.sh installs.\n"
    rows = [_accuracy(row) + [_of(row, name) for name in ("cortex-m4", "cortex-m7", "sanitized")]
            for _, row in variants.iterrows()]  # fmt: skip
    accuracy = _table((*ACCURACY, *MACHINES), rows)
    cost = _table(COST, [_cost(row) for _, row in variants.iterrows()])
    return f"{accuracy}\n{cost}\n{_advised(variants, part, advice)}\n"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, [":--", *["--:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _accuracy(row: pd.Series) -> list[str]:
    interval = f" ({row['low']:.1f} to {row['high']:.1f})" if np.isfinite(row["low"]) else ""  # few gears
    same = [_of(row, name) for name in ("unseen", "disturbed")]
    return [
        str(row.name),
        f"{row['unseen']:.1f}{interval}",
        f"{row['disturbed']:.1f}",
        *same,
        f"{row['difference']:.0e}",
    ]


def _cost(row: pd.Series) -> list[str]:
    flash = [f"{row[name] / 1024:.1f}" for name in BYTES]
    counts = [f"{row[name] / 1000:.0f}" for name in COUNTS]
    return [str(row.name), *flash, *counts, f"{row['longest_push'] / 1000:.1f}"]


def _of(row: pd.Series, name: str) -> str:
    return f"{row[f'{name}_equal']:.0f} of {row[f'{name}_recordings']:.0f}"


def _advised(variants: pd.DataFrame, part: Part, advice: Recommendation | None) -> str:
    needs = (
        f"{part.flash / 1024:.0f} kB of flash, {part.ram / 1024:.0f} kB of RAM, {part.rate:g} decisions a second of "
        f"samples at {part.sampling / 1000:g} kHz, and {part.instructions / 1e6:g} million instructions a second"
    )
    left_out = _listed("These do not fit", variants.index[~part.fits(variants)])
    left_out += _listed(f"Less than {FAITHFUL} % of labels as in Python", variants.index[variants["same"] < FAITHFUL])
    if advice is None:
        return f"None of the methods fits into {needs}.{left_out}"
    row = variants.loc[advice.variant]
    chosen = (
        f"For {needs}: **{advice.variant}**, {row['flash'] / 1024:.1f} kB of flash, {row['ram'] / 1024:.1f} kB of RAM, "
        f"{part.rate * row['instructions'] / 1e6:.1f} million instructions a second."
    )
    if advice.variant == advice.most_accurate:
        reason = "On unseen gears it is the most accurate one that fits; no smaller one is known to be as accurate."
        return f"{chosen} {reason}{left_out}"
    more = f"{advice.difference:.1f} points more ({advice.low:.1f} to {advice.high:.1f})"
    return (
        f"{chosen} Of those that fit, {advice.most_accurate} is the most accurate on unseen gears. The recommended "
        f"method errs {more}, with the interval of a bootstrap over gears and specimens. It is the smallest one whose "
        f"error is not significantly larger.{left_out}"
    )


def _listed(what: str, names: pd.Index) -> str:
    return f" {what}: {'; '.join(names)}." if len(names) else ""
