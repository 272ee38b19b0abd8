"""The outcome of the study, and what it says in the words of the loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from learn.paper.paper_page import ROMAN
from learn.paper.published_tables import row_label
from learn.paper_choices.analysis import Fit, Held, interval
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import Tables
from learn.paper_choices.reading import word
from learn.paper_choices.search import Trial


@dataclass(frozen=True)
class Outcome:
    """What the study found.

    Attributes
    ----------
    choices : sequence of Choice
    trials : sequence of Trial
    fit : Fit
    before, after : mapping
        The tables under the values of grid=paper and under those that were found, all cells.
    unreduced : mapping
        The tables under all values of the best trial, most of which are not needed.
    claims_before, claims_after : mapping
        C1 to C18 to whether they hold.
    held : mapping
        The same over the drawn choices.
    effects : DataFrame
        As of :func:`learn.paper_choices.analysis.effects`.
    parts : mapping
        As of :func:`learn.paper_choices.analysis.parts_held`.
    """

    choices: Sequence[Choice]
    trials: Sequence[Trial]
    fit: Fit
    before: Tables
    after: Tables
    unreduced: Tables
    claims_before: Mapping[str, bool]
    claims_after: Mapping[str, bool]
    held: Mapping[str, Held]
    effects: pd.DataFrame
    parts: Mapping[str, Mapping[str, float]]

    def fields(self) -> dict[str, Any]:
        """``paper_choices.json``."""
        return {
            "before": errors(self.before),
            "after": errors(self.after),
            "unreduced": errors(self.unreduced),
            "rank_correlation": round(rank_correlation(self.after), 3),
            "rank_correlations": {
                name: round(rank_correlation(tables), 3)
                for name, tables in (("before", self.before), ("after", self.after), ("unreduced", self.unreduced))
            },
            "choices": {
                each.name: {
                    "value": self.fit.values[each.name],
                    "interval": list(self.fit.intervals[each.name]) if each.fitted else None,
                }
                for each in self.choices
            },
            "claims": {
                key: {
                    "share": round(held.share, 3),
                    "interval": [round(end, 3) for end in interval(held.share, self.draws)],
                    "depends_on": list(held.depends_on),
                    "reading": word(key, held),
                }
                for key, held in self.held.items()
            },
        }

    @property
    def draws(self) -> int:
        """Number of sets of choices that were drawn from the priors."""
        return sum(trial.sampled for trial in self.trials)

    @property
    def found(self) -> list[Choice]:
        """Choices whose usual value is not among those that fit as well, the most unusual first."""
        other = [each for each in self.choices if self.fit.values[each.name] != each.usual]
        return sorted(other, key=lambda each: -abs(each.deviation(self.fit.values[each.name])))

    @property
    def answer(self) -> str:
        """What the paper's chain has that ours lacks, as far as the intervals show it."""
        if not self.found:
            return "No choice that the paper leaves open is known to differ from ours: our values fit as well."
        shown = [each for each in self.found if not self._holds_ours(each)]
        other = [each for each in self.found if self._holds_ours(each)]
        lacks = f"The paper's chain has what ours lacks: {self._texts(shown)}." if shown else ""
        fits = (
            f"{'Also' if shown else 'These values'} fit better, but our values are within the intervals, so nothing is "
            f"shown to be missing: {self._texts(other)}."
        )
        return f"{lacks} {fits}".strip() if other else lacks

    def _holds_ours(self, choice: Choice) -> bool:
        low, high = self.fit.intervals[choice.name]
        return low <= choice.usual <= high

    def _texts(self, choices: Sequence[Choice]) -> str:
        return "; ".join(self.text(each) for each in choices)

    def text(self, choice: Choice) -> str:
        """A choice with the value that was found and its interval."""
        value, (low, high) = self.fit.values[choice.name], self.fit.intervals[choice.name]
        if choice.scale == "yes_no":
            return f"{choice.meaning}: {'yes' if value else 'no'} (ours {'yes' if choice.usual else 'no'})"
        unit = "" if choice.unit == "-" else f" {choice.unit}"
        return f"{choice.meaning}: {value:.2g}{unit} ({low:.2g} to {high:.2g}; ours {choice.usual:.2g})"

    @property
    def judgement(self) -> str:
        """Which tables come nearer by more than the scatter of their cells."""
        changes = {ROMAN[name]: self._change(name) for name in self.after}
        nearer = [name for name, (mean, error) in changes.items() if mean < -2 * error]
        further = [name for name, (mean, error) in changes.items() if mean > 2 * error]
        rest = [name for name in changes if name not in nearer + further]
        words = [
            f"{text}: {', '.join(names)}."
            for text, names in (
                ("Clearly nearer than before", nearer),
                ("Clearly further away", further),
                ("Changed by less than two standard errors", rest),
            )
            if names
        ]
        figures = ", ".join(f"{name} {mean:+.1f} ± {error:.1f}" for name, (mean, error) in changes.items())
        return f"{' '.join(words)} Mean change and its standard error over the cells: {figures} points."

    def _change(self, name: str) -> tuple[float, float]:
        """Mean change of the differences to the paper, and its standard error over the cells [points]."""
        now, then = (tables[name].figures for tables in (self.after, self.before))
        changes = (now["ours"] - now["paper"]).abs() - (then["ours"] - then["paper"]).abs()
        return float(changes.mean()), float(changes.std() / np.sqrt(len(changes)))


def errors(tables: Tables) -> dict[str, float]:
    """Mean absolute difference of each table to the paper's [points]."""
    return {name: round(table.mean_absolute_difference, 3) for name, table in tables.items()}


def rank_correlation(tables: Tables) -> float:
    """Mean over all rows of all tables of Spearman's rank correlation of the classifiers."""
    return float(np.nanmean([rho for table in tables.values() for rho in table.rank_correlation.values()]))


def cells(before: Tables, after: Tables, unreduced: Tables) -> list[dict[str, Any]]:
    """All cells of the tables: the paper's, and ours under three sets of values."""
    rows = []
    for table, comparison in after.items():
        others = (before[table].cells["ours"], unreduced[table].cells["ours"])
        for cell, earlier, whole in zip(comparison.cells.to_dict("records"), *others, strict=True):
            row = row_label(cell["features"], cell["row"])
            rows.append({
                "table": table, "row": row, "classifier": cell["classifier"], "relation": cell["relation"],
                "paper": cell["paper"], "before": round(earlier, 2), "after": round(cell["ours"], 2),
                "unreduced": round(whole, 2),
            })  # fmt: skip
    return rows
