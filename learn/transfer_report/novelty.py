"""Whether a gear shows by its healthy reference alone that it is unlike the gears a method has learnt from."""

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd

from learn.evaluation.selective import gear_novelty, novelty_auroc, novelty_left_out
from learn.inputs.references import HEALTHY
from learn.transfer_report.results import finite
from swgsim.storage import storage
from swgsim.storage.orders import lines_of

BLOCK = 1024  # recordings in memory at a time
ORDERS = 4  # those of the kinematic error and of the ellipse's deflection, which differ between gears
FEWEST_GEARS = 4  # one left out of three


@dataclass(frozen=True)
class Novelty:
    """Novelty of gears by their healthy references.

    Attributes
    ----------
    usual : DataFrame
        Per judged gear its ``novelty`` beside all other gears of the data set, and the ``error`` of a method [%].
    foreign : Series or None
        Novelty of gears from another population; None where there are none with the same operating points.
    """

    usual: pd.DataFrame
    foreign: pd.Series | None

    @property
    def threshold(self) -> float:
        """The largest novelty of a usual gear."""
        return float(self.usual["novelty"].max())

    def sentences(self, method: str) -> str:
        """What the novelty tells, in words."""
        said = (
            'Saying "I do not know this gear": novelty is the distance of a gear\'s healthy reference (order lines and '
            f"efficiency at all operating points) from those of the others. The {len(self.usual)} judged gears, each "
            f"left out of the others, have {self.usual['novelty'].min():.2f} to {self.threshold:.2f}. "
        )
        if self.foreign is None:
            said += "Gears far outside them (far-bench) are not there, or at other operating points: not compared."
        else:
            beyond = int((self.foreign > self.threshold).sum())
            auroc = novelty_auroc(self.usual["novelty"].to_numpy(), self.foreign.to_numpy())
            said += (
                f"The {len(self.foreign)} gears of grid=far have {self.foreign.min():.2f} to {self.foreign.max():.2f}; "
                f"{beyond} of them exceed the largest of the usual gears. The probability that a far gear scores above "
                f"a usual one (AUROC) is {auroc:.2f}."
            )
        return f"{said} {self._with_the_error(method)}"

    def _with_the_error(self, method: str) -> str:
        """Whether gears of higher novelty are those on which a method errs more."""
        from scipy.stats import spearmanr

        if (self.usual.nunique() < 2).any():
            return f"Whether it goes along with the error of {method} cannot be said: all gears are alike."
        rank, p = spearmanr(self.usual["novelty"], self.usual["error"])
        verdict = "goes along" if rank > 0 and p < 0.05 else "does not clearly go along"
        return (
            f"Among the judged gears novelty {verdict} with the error of {method} (Spearman's rank correlation "
            f"{rank:+.2f}, p = {finite(p, 2)})."
        )


def healthy_means(path: Path) -> pd.DataFrame:
    """Means of the reference acquisitions of every gear (rows), the operating points side by side (columns).

    Values are real and imaginary parts of the order lines of all gauges [mV/V], and the efficiency [-].
    """
    lines, facts = [], []
    for block in storage.blocks(path, BLOCK):
        references = block.where(block.table["reference"])
        if len(references):
            lines.append(lines_of(references, ORDERS).reshape(len(references), -1))
            facts.append(references.table)
    table, every = pd.concat(facts, ignore_index=True), np.concatenate(lines)
    values = np.column_stack([every.real, every.imag, table["efficiency"]])
    means = pd.DataFrame(values).groupby([table[name] for name in HEALTHY]).mean()
    return cast(pd.DataFrame, means.unstack([1, 2]))


def novelty(bench: Path, far: Path | None, errors: pd.Series) -> Novelty | None:
    """Novelty of judged gears beside all others, and of far gears beside all.

    Parameters
    ----------
    bench, far : Path
        Data sets; None for `far` if there is none.
    errors : Series
        Error of every judged gear [%], by its number.

    Returns
    -------
    Novelty or None
        None if there are too few gears to leave one out.
    """
    known = healthy_means(bench)
    if len(known) < FEWEST_GEARS:
        return None
    usual = pd.Series(novelty_left_out(known.to_numpy()), known.index, name="novelty")
    table = pd.DataFrame({"novelty": usual, "error": errors}).loc[errors.index]
    other = healthy_means(far) if far else None
    if other is None or not other.columns.equals(known.columns):
        return Novelty(table, None)
    return Novelty(table, pd.Series(gear_novelty(known.to_numpy(), other.to_numpy()), other.index))
