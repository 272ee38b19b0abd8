"""The report: our tables, claims and figures with those of the paper, as one HTML page and as JSON."""

import json
import platform
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np
import pandas as pd

from learn.paper.fitted import Fitted
from learn.paper.published_tables import PROTOCOLS, Comparison, row_label
from learn.tracking import Store, finished_runs
from swgsim.common.html import environment
from swgsim.common.style import Picture, words
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.studies.finding import Finding

ROMAN: Mapping[str, str] = {"table7": "VII", "table8": "VIII", "table9": "IX", "table10": "X"}
TITLES: Mapping[str, str] = {
    "table7": "training and test score for different selections",
    "table8": "score on disturbed data (the paper's figures as far as its text states them)",
    "table9": "score on a gear left out of training",
    "table10": "score on a gear left out of training, disturbed data",
}
CLASSIFIERS = ("mlp", "svm", "rf", "knn", "nb")
RELATIONS: Mapping[str, str] = {"about": "", "above": "> ", "at most": "≤ "}
DATASET = ("recordings", "seconds", "recordings_per_second", "peak_memory_mib", "cores")
FULL_COLOUR = 30  # points of difference at which a cell has its full colour
# The spaces of "7 N m", "2000 rpm", "Table X" and "eq. (10)".
UNIT = re.compile(
    r"(?<=\d) (?=(?:m?N m|rpm|[mµ]V/V|Hz|µm|MiB|s|%)(?!\w))|(?<=[ \[m]N) (?=m(?!\w))"
    r"|(?<=Table) (?=[IVX])|(?<=eq\.) (?=\()"
)


@dataclass(frozen=True)
class Report:
    """Content of the report.

    Attributes
    ----------
    grid : str
        Name of the grid.
    dataset : mapping
        recordings, seconds, recordings_per_second, peak_memory_mib and cores of the clean data set's generation.
    tables : mapping
        ``table7`` to ``table10``.
    folds : mapping
        ``table7`` and ``table8`` to the scores with random and with grouped folds.
    findings : sequence of Finding
        C1 to C18.
    choices : sequence of (topic, text)
    fitted : Fitted or None
        Result with the choices that were fitted to Tables VII and IX; None for another grid than the paper's.
    statistics : sequence of mapping
        Of the clean data set, one row per operating point; column to text.
    pictures : sequence of Picture
    seconds : float
        Of the whole, counted as ``seconds_are`` says.
    steps : mapping
        Seconds of single steps.
    versions : mapping
    """

    grid: str
    dataset: Mapping[str, float]
    tables: Mapping[str, Comparison]
    folds: Mapping[str, pd.DataFrame]
    findings: Sequence[Finding]
    choices: Sequence[tuple[str, str]]
    fitted: Fitted | None
    statistics: Sequence[Mapping[str, str]]
    pictures: Sequence[Picture]
    seconds: float
    seconds_are: str
    steps: Mapping[str, float]
    versions: Mapping[str, str]

    def json(self) -> str:
        """``report.json``."""
        content = {
            "grid": self.grid,
            "dataset": dict(self.dataset),
            "tables": {name: table.summary() for name, table in self.tables.items()},
            "claims": {f.key: {"holds": f.holds, "figure": f.figure, "note": f.note} for f in self.findings},
            "seconds": round(self.seconds, 1),
            "seconds_are": self.seconds_are,
            "seconds_of_steps": {name: round(value, 1) for name, value in self.steps.items()},
            "versions": dict(self.versions),
        }
        return json.dumps(content, indent=2, allow_nan=False) + "\n"

    def html(self, beyond: bool = False) -> str:
        """``index.html``: one file with its pictures.

        Parameters
        ----------
        beyond : bool
            Whether ``transfer.html`` is in the same folder; the page then has a link to it.
        """
        page = environment("learn").get_template("paper/paper_page.html.jinja")
        text = page.render(
            report=self,
            beyond=beyond,
            held=[f for f in self.findings if f.holds],
            failed=[f for f in self.findings if not f.holds],
            tables=[_table(name, comparison, self.fitted) for name, comparison in self.tables.items()],
            folds=[{"title": ROMAN[name], "rows": _folds(frame)} for name, frame in self.folds.items()],
            classifiers=[name.upper() for name in CLASSIFIERS],
            rest=round(self.seconds - sum(self.steps.values())),
        )
        return unbroken(text)


def unbroken(html: str) -> str:
    """A page whose numbers are not separated from their units at the end of a line.

    >>> unbroken("at 7 N m [N m] and 2000 rpm").replace("\\u00a0", "_")
    'at 7_N_m [N_m] and 2000_rpm'
    """
    return UNIT.sub("\u00a0", html)


def require_same_code(codes: Mapping[str, str], grid: str, data: str = "data") -> None:
    """Check that all data sets were made by the same version of the chain.

    Parameters
    ----------
    codes : mapping
        Version by data set.
    grid, data : str
        Of the command that the message advises.

    Raises
    ------
    ValueError
        If they were not; it names the versions and the command that makes them anew.
    """
    if len(set(codes.values())) > 1:
        versions = ", ".join(f"{condition} by {code}" for condition, code in codes.items())
        raise ValueError(
            f"the data sets of grid={grid} were made by different versions: {versions}. Make them again with "
            f"'swg generate grid={grid} condition=... data={data}' for each of {', '.join(codes)}"
        )


def runs_of_tables(store: Store, grid: str, digests: Mapping[str, str], command: str) -> pd.DataFrame:
    """The finished runs of the paper's tables on the present data sets.

    Parameters
    ----------
    store : Store
    grid : str
    digests : mapping
        Condition to digest of the data set.
    command : str
        Command that makes runs, without its experiment; the message advises it.

    Raises
    ------
    ValueError
        If there are no such runs; it names the command that makes them.
    """
    runs = finished_runs(store, grid=grid)
    if len(runs):
        runs = runs[runs["data_digest"].isin(digests.values()) & runs["study"].isin(PROTOCOLS)]
    if not len(runs):
        commands = " ".join(f"experiment={table}" for table in PROTOCOLS)
        raise ValueError(
            f"no finished run on the present data sets of grid={grid} in {store.uri}: run "
            f"'{command} experiment=...' with each of {commands}"
        )
    return runs


def complete(comparison: Comparison, table: str, command: str) -> Comparison:
    """The comparison itself, of which every cell has a run.

    Raises
    ------
    ValueError
        If a cell has no run; it names the first and the command that makes it.
    """
    missing = comparison.cells[comparison.cells["ours"].isna()]
    if len(missing):
        cell = missing.iloc[0]
        raise ValueError(
            f"{len(missing)} of {len(comparison.cells)} cells of {table} have no run on the present data set. "
            f"The first is {cell['classifier']}, {row_label(cell['features'], cell['row'])}: run "
            f"'{command} experiment={table}'"
        )
    return comparison


def statistics(blocks: Sequence[LabelledSignals]) -> list[dict[str, str]]:
    """Per operating point: recordings, healthy efficiency of each gear, amplitude of s1 and mean of s0."""
    table = pd.concat([block.table for block in blocks], ignore_index=True)
    table["s1"] = np.concatenate([np.ptp(block.signals[:, 1], axis=1) / 2 for block in blocks])
    table["s0"] = np.concatenate([block.signals[:, 0].mean(axis=1) for block in blocks])
    rows = []
    for (speed, load), point in table.groupby(["n_in_rpm", "T_out_nm"]):
        healthy = point[point["reference"]].groupby("gear")[["efficiency", "s1", "s0"]].mean()
        rows.append({
            "operating point": f"{speed:g} rpm, {load:g} N m",
            "recordings": f"{len(point)}",
            "healthy references among them": f"{point['reference'].sum()}",
            "efficiency of the healthy gears [%]": ", ".join(f"{100 * e:.1f}" for e in healthy["efficiency"]),
            "with faults, least to most [%]": f"{100 * point['efficiency'].min():.1f} to "
            f"{100 * point['efficiency'].max():.1f}",
            "amplitude of s1 [mV/V]": ", ".join(f"{a:.3f}" for a in healthy["s1"]),
            "mean of s0 [mV/V]": ", ".join(f"{m:.3f}" for m in healthy["s0"]),
        })  # fmt: skip
    return rows


def versions(code: str, digests: Mapping[str, str]) -> dict[str, str]:
    """Versions of the code, of the data and of the libraries below."""
    libraries = ("numpy", "scipy", "scikit-learn", "matplotlib", "mlflow")
    return {
        "swgsim": code,
        "python": platform.python_version(),
        **{name: version(name) for name in libraries},
        **{f"data set {name}": digest[:12] for name, digest in digests.items()},
    }


def shade(difference: float) -> str:
    """Background of a cell: blue where ours is higher, orange where it is lower, white where both agree."""
    strength = min(abs(difference) / FULL_COLOUR, 1)
    colour = "0,114,178" if difference > 0 else "230,120,0"
    return f"rgba({colour},{0.6 * strength:.2f})"


def _table(name: str, comparison: Comparison, fitted: Fitted | None) -> dict[str, Any]:
    """A table as rows of cells for the template."""
    rows: dict[str, dict[str, dict[str, str]]] = {}
    for cell in comparison.cells.to_dict("records"):
        difference, relation = cell["ours"] - cell["paper"], cell["relation"]
        agrees = (relation == "above" and difference > 0) or (relation == "at most" and difference <= 0)
        row = row_label(cell["features"], cell["row"])
        rows.setdefault(row, {})[cell["classifier"].upper()] = {
            "fitted": f"{fitted.scores[name, row, cell['classifier']]:.1f}" if fitted else "",
            "ours": f"{cell['ours']:.1f}",
            "paper": f"{RELATIONS[relation]}{cell['paper']:.1f}",
            "shade": shade(0 if agrees else difference),
        }
    rank = comparison.rank_correlation
    return {
        "title": f"Table {ROMAN[name]}: {TITLES[name]}",
        "rows": [(label, cells, f"{rank[label]:.2f}" if label in rank else "-") for label, cells in rows.items()],
        "difference": comparison.mean_absolute_difference,
        "fitted": fitted.errors[name] if fitted else None,
        "compared": len(comparison.figures),
    }


def _folds(frame: pd.DataFrame) -> list[tuple[str, ...]]:
    return [
        (words(row["features"]), row["classifier"].upper(), *(f"{row[c]:.1f}" for c in ("random", "grouped")),
         f"{round(row['difference'], 1) + 0.0:+.1f}")  # + 0.0: no minus zero
        for row in frame.sort_index().reset_index().to_dict("records")
    ]  # fmt: skip
