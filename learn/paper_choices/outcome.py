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
    "C11": "RF and KNN, Table VII",
    "C12": "MLP is good on Selection 3 alone",
    "C13": "NB and SVM, Table VII",
    "C14": "Selection 2 does not improve",
    "C15": "figures of Table VIII",
    "C16": "figures of Table IX",
    "C17": "figures of Table X",
    "C18": "RF is most robust, yet not good enough",
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
            return f"{choice.meaning}: {'yes' if value else 'no'}, ours {'yes' if choice.usual else 'no'}"
        unit = "" if choice.unit == "-" else f" {choice.unit}"
        return f"{choice.meaning} {value:.3g}{unit} ({low:.3g} to {high:.3g}), ours {choice.usual:.3g}{unit}"

    @property
    def judgement(self) -> str:
        """Whether the tables that the fit never saw come nearer as well."""
        worse = [name for name in self.after if name not in FITTED and self._change(name) > 0]
        if not worse:
            return "Tables VIII and X come nearer, too: they support the fit."
        names = " and ".join(f"Table {ROMAN[name]} ({self._change(name):+.1f} points)" for name in worse)
        return f"Further away than before: {names}. So part of what was found is not what the paper did."

    def _change(self, name: str) -> float:
        return self.after[name].mean_absolute_difference - self.before[name].mean_absolute_difference

    @property
    def remaining(self) -> list[tuple[str, float]]:
        """The mean difference to the paper [points] of each classifier on each selection and table, largest first."""
        rows = []
        for table, comparison in self.after.items():
            cells = comparison.figures.assign(difference=comparison.figures["ours"] - comparison.figures["paper"])
            for (features, name), group in cells.groupby(["features", "classifier"]):
                label = f"{str(name).upper()} on {str(features).replace('_', ' ')}, Table {ROMAN[table]}"
                rows.append((label, float(group["difference"].mean())))
        return sorted(rows, key=lambda row: -abs(row[1]))


def errors(tables: Tables) -> dict[str, float]:
    """Mean absolute difference of each table to the paper's [points]."""
    return {name: round(table.mean_absolute_difference, 3) for name, table in tables.items()}


def rank_correlation(tables: Tables) -> float:
    """Mean over all rows of all tables of Spearman's rank correlation of the classifiers."""
    return float(np.nanmean([rho for table in tables.values() for rho in table.rank_correlation.values()]))


def reading(held: Mapping[str, Held], parts: Mapping[str, Mapping[str, float]]) -> str:
    """Which conclusions of the paper hold on any plausible choice, which on some, and which on none.

    Of a claim that does not hold as a whole, the parts that hold on most draws are counted.
    """
    groups: dict[str, list[str]] = {"always": [], "mostly": [], "seldom": [], "never": []}
    depending = []
    for key, each in held.items():
        shares = list(parts.get(key, {}).values())
        words = [WORDS[key]]
        if each.share <= 0.5 and len(shares) > 1:
            words.append(f"{sum(share > 0.5 for share in shares)} of {len(shares)} parts on most")
        if each.words in groups:
            groups[each.words].append(f"{key} ({', '.join(words)})")
        else:
            depending.append(f"{key} ({', '.join(words)}: {each.depends_on[0].replace('_', ' ')})")
    texts = {
        "Hold on every plausible choice": groups["always"],
        "depend on a choice that the paper does not state": depending,
        "hold on most, by no single choice": groups["mostly"],
        "hold on few, by no single choice": groups["seldom"],
        "do not come out on any": groups["never"],
    }
    return "; ".join(f"{words}: {', '.join(keys)}" for words, keys in texts.items() if keys) + "."


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
