"""Errors of models on gears that they were adapted to."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from learn.inputs.inputs import SPECIMEN
from learn.protocols.levels import Target


@dataclass(frozen=True)
class Adapted:
    """Errors of adapted models.

    Attributes
    ----------
    specimens : DataFrame
        ``gear``, ``label``, ``variant``, ``shots``; ``error``, share of wrong decisions over operating points and draws
        [%]; ``unit``, the same of decisions by all operating points together; ``unadapted``, ``error`` of the source
        model [%].
    gears : DataFrame
        ``gear``, ``shots``; ``error`` and ``unadapted`` as above [%]; ``forgotten``, loss of accuracy on source gears
        by the adaptation [points].
    """

    specimens: pd.DataFrame
    gears: pd.DataFrame

    @classmethod
    def of(cls, parts: Sequence["Adapted"]) -> "Adapted":
        """The errors of several parts, each of other gears or numbers of shots."""
        specimens, gears = ([getattr(part, name) for part in parts] for name in ("specimens", "gears"))
        return cls(pd.concat(specimens, ignore_index=True), pd.concat(gears, ignore_index=True))

    @classmethod
    def of_gear(
        cls,
        table: pd.DataFrame,
        target: Target,
        shots: int,
        wrong: Sequence[Bool[np.ndarray, " judged"]],
        wrong_unit: Sequence[Bool[np.ndarray, " judged"]],
        unadapted: Bool[np.ndarray, " judged"],
        forgotten: Sequence[float],
    ) -> "Adapted":
        """Errors on one gear with one number of shots.

        Parameters
        ----------
        table : DataFrame
            Facts of all samples.
        target : Target
        shots : int
        wrong : sequence of array (judged,)
            Whether the adapted model of each draw decides wrongly.
        wrong_unit : sequence of array (judged,)
            The same of its decision on the whole unit.
        unadapted : array (judged,)
            The same of the source model.
        forgotten : sequence of float
            Loss of accuracy on the source gears in each draw [points].
        """
        error: Float[np.ndarray, " judged"] = 100 * np.mean(wrong, axis=0)
        facts = table.iloc[target.judged][list(SPECIMEN)]
        rows = facts.assign(
            label=facts["label"].astype(str), shots=shots, error=error,
            unit=100 * np.mean(wrong_unit, axis=0), unadapted=100.0 * unadapted,
        )  # fmt: skip
        specimens = rows.groupby([*SPECIMEN, "shots"])[["error", "unit", "unadapted"]].mean().reset_index()
        of_gear = (target.gear, shots, error.mean(), 100.0 * unadapted.mean(), float(np.mean(forgotten)))
        names = ["gear", "shots", "error", "unadapted", "forgotten"]
        return cls(specimens, pd.DataFrame([of_gear], columns=names))

    def mean_error(self) -> float:
        """Mean over gears and numbers of shots [%]."""
        return float(self.gears["error"].mean())

    def metrics(self) -> dict[str, float]:
        """Means over gears for each number of shots, rounded to three decimals, by metric name."""
        means = self.gears.groupby("shots")[["error", "unadapted", "forgotten"]].mean()
        each = {f"{name}/{shots}_shots": value for name, column in means.items() for shots, value in column.items()}
        return {name: round(value, 3) for name, value in {"test_score": 100 - self.mean_error(), **each}.items()}
