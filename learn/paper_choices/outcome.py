"""The outcome of the study, and what it says in the words of the loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from learn.paper.paper_page import ROMAN
from learn.paper.published_tables import row_label
from learn.paper_choices.analysis import Fit, Held
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import FITTED, Tables
from learn.paper_choices.search import Trial

WORDS = {
    "C1": "damping hardly shows in the signals",
    "C2": "stiffness shows in s0 alone",
    "C3": "eccentricity distorts s1 and s3",
    "C4": "a root crack changes all amplitudes",
    "C5": "a tip crack shows shortly in s1 and s3",
    "C6": "less damping, higher efficiency",
    "C7": "run-in",
    "C8": "opposite gauges are alike",
    "C9": "three faults separate in the DFT of differences",
    "C10": "the fourth root separates small changes",
    "C11": "RF and KNN are best on the same gears",
    "C12": "MLP is good on Selection 3 alone",
    "C13": "NB is good on Selection 1 alone, SVM is last",
    "C14": "Selection 2 does not improve the scores",
    "C15": "the scores of Table VIII, disturbed",
    "C16": "the scores of Table IX, another gear",
    "C17": "the scores of Table X, another gear and disturbed",
    "C18": "RF is most robust, yet not good enough",
}

# How a claim holds over the drawn choices (:attr:`~learn.paper_choices.analysis.Held.words`), in the order of a reader.
GROUPS = {
    "always": "Hold on every plausible choice",
    "depends": "Depend on a choice that the paper does not state",
    "mostly": "Hold on most sets of choices, and no single choice decides",
    "seldom": "Hold on few sets of choices, and no single choice decides",
    "never": "Do not come out on any",
}


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
            "choices": {
                each.name: {"value": self.fit.values[each.name], "interval": list(self.fit.intervals[each.name])}
                for each in self.choices
            },
            "claims": {
                key: {"share": round(held.share, 3), "depends_on": list(held.depends_on)}
                for key, held in self.held.items()
            },
        }

    @property
    def found(self) -> list[Choice]:
        """Choices whose usual value is not among those that fit as well, the most unusual first."""
        other = [each for each in self.choices if self.fit.values[each.name] != each.usual]
        return sorted(other, key=lambda each: -abs(each.deviation(self.fit.values[each.name])))

    @property
    def answer(self) -> str:
        """What the paper's chain has that ours lacks, in a sentence."""
        if not self.found:
            return "No choice that the paper leaves open is known to differ from ours: our values fit as well."
        found = "The paper's chain has what ours lacks: " + "; ".join(self.text(each) for each in self.found) + "."
        ends = [(each.usual, *self.fit.intervals[each.name]) for each in self.found]
        open_ones = sum(low <= usual <= high for usual, low, high in ends)
        if not open_ones:
            return found
        return f"{found} Of these intervals {open_ones} hold our value, so other choices can take the place of those."

    def text(self, choice: Choice) -> str:
        """A choice with the value that was found and its interval."""
        value, (low, high) = self.fit.values[choice.name], self.fit.intervals[choice.name]
        if choice.scale == "yes_no":
            return f"{choice.meaning}: {'yes' if value else 'no'} (ours {'yes' if choice.usual else 'no'})"
        unit = "" if choice.unit == "-" else f" {choice.unit}"
        return f"{choice.meaning}: {value:.2g}{unit} ({low:.2g} to {high:.2g}; ours {choice.usual:.2g})"

    @property
    def judgement(self) -> str:
        """Whether the tables that the fit never saw come nearer as well."""
        worse = [name for name in self.after if name not in FITTED and self._change(name) > 0]
        if not worse:
            return (
                "Tables VIII and X come nearer, too. The fit never saw them, but its authors did: earlier forms of the "
                "study had been judged on them before its method was changed. So they support the fit, yet they are no "
                "blind test."
            )
        names = " and ".join(f"Table {ROMAN[name]} ({self._change(name):+.1f} points)" for name in worse)
        return f"Further away than before: {names}. So part of what was found is not what the paper did."

    def _change(self, name: str) -> float:
        return self.after[name].mean_absolute_difference - self.before[name].mean_absolute_difference


def errors(tables: Tables) -> dict[str, float]:
    """Mean absolute difference of each table to the paper's [points]."""
    return {name: round(table.mean_absolute_difference, 3) for name, table in tables.items()}


def rank_correlation(tables: Tables) -> float:
    """Mean over all rows of all tables of Spearman's rank correlation of the classifiers."""
    return float(np.nanmean([rho for table in tables.values() for rho in table.rank_correlation.values()]))


def reading(held: Mapping[str, Held], parts: Mapping[str, Mapping[str, float]]) -> dict[str, str]:
    """Which claims of the paper hold on any plausible choice, which on some, and which on none, group by group.

    Of a claim that seldom holds as a whole, the parts that hold on most draws are counted.
    """
    groups: dict[str, list[str]] = {words: [] for words in GROUPS}
    for key, each in held.items():
        groups[each.words if each.words in groups else "depends"].append(_in_words(key, each, parts.get(key, {})))
    return {GROUPS[words]: "; ".join(texts) for words, texts in groups.items() if texts}


def _in_words(key: str, held: Held, parts: Mapping[str, float]) -> str:
    shares = list(parts.values())
    few = held.share <= 0.5 and len(shares) > 1
    robust = f", {sum(share > 0.5 for share in shares)} of {len(shares)} parts hold on most" if few else ""
    choice = f": {held.depends_on[0].replace('_', ' ')}" if held.depends_on else ""
    return f"{WORDS[key]} ({key}{choice}{robust})"


def cells(before: Tables, after: Tables) -> list[dict[str, Any]]:
    """All cells of the tables: paper, before and after."""
    rows = []
    for table, comparison in after.items():
        ours_before = before[table].cells["ours"]
        for cell, earlier in zip(comparison.cells.to_dict("records"), ours_before, strict=True):
            row = row_label(cell["features"], cell["row"])
            rows.append({
                "table": table, "row": row, "classifier": cell["classifier"], "relation": cell["relation"],
                "paper": cell["paper"], "before": round(earlier, 2), "after": round(cell["ours"], 2),
            })  # fmt: skip
    return rows
