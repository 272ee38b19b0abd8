"""Recommends a method for a part: the smallest that fits, is faithful and not significantly worse than the best."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd

from learn.embedded.proof import FAITHFUL
from learn.evaluation.bootstrap import difference_to, gear_bootstrap
from learn.inputs.inputs import SPECIMEN


@dataclass(frozen=True)
class Part:
    """A microcontroller and the requirements on it.

    Attributes
    ----------
    flash, ram : int
        Bytes.
    rate, sampling : float
        Decisions and samples per second.
    instructions : float
        Per second that are available for the classifier.
    """

    flash: int
    ram: int
    rate: float
    sampling: float
    instructions: float

    @classmethod
    def of(cls, config: Mapping[str, float]) -> "Part":
        """The part of ``part`` of a configuration."""
        kib = 1024
        flash, ram = (round(config[name] * kib) for name in ("flash_kib", "ram_kib"))
        return cls(flash, ram, config["rate"], config["sampling"], 1e6 * config["mips"])

    def fits(self, variants: pd.DataFrame) -> pd.Series:
        """Whether each variant fits, with decisions and every single sample in time."""
        return (
            (variants["flash"] <= self.flash)
            & (variants["ram"] <= self.ram)
            & (self.rate * variants["most_instructions"] <= self.instructions)
            & (self.sampling * variants["longest_push"] <= self.instructions)
        )


class Recommendation(NamedTuple):
    """The chosen variant, the most accurate one that fits, and the additional error of the chosen one [points]."""

    variant: str
    most_accurate: str
    difference: float
    low: float
    high: float


def recommend(
    variants: pd.DataFrame, errors: pd.DataFrame, part: Part, rng: np.random.Generator
) -> Recommendation | None:
    """The smallest of those that fit, are faithful and not significantly worse than the best; None if none fits.

    Parameters
    ----------
    variants : DataFrame
        Of :func:`learn.embedded.table.variants_of`, with flash and instructions.
    errors : DataFrame
        Errors [%] of each variant (column) on unseen gears, as :func:`bootstrap.gear_bootstrap`
        takes them.
    part : Part
    rng : Generator
    """
    fitting = variants.index[part.fits(variants) & (variants["same"] >= FAITHFUL)]
    if fitting.empty:
        return None
    of_fitting = errors[[*SPECIMEN, *fitting]]
    best = str(of_fitting[list(fitting)].mean().idxmin())
    others = gear_bootstrap(of_fitting, difference_to(best), rng)
    none = pd.DataFrame({"value": 0.0, "low": 0.0, "high": 0.0}, index=pd.Index([best]))
    table = pd.concat([none, others])
    candidates = table.index[table["low"] <= 0]  # of few gears the bounds are not known, and the best one stays
    chosen = str(variants.loc[candidates, "flash"].idxmin())
    return Recommendation(chosen, best, *(float(value) for value in table.loc[chosen].to_numpy()))
