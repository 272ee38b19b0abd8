"""The result of an identification: verdict, report, table, pictures and files."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from swgsim.common.files import write_json, write_text
from swgsim.effects.text import as_text
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.engineering_units import in_unit, parameter_words

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from swgsim.common.style import Picture


@dataclass(frozen=True, eq=False)
class Identification:
    """The result of :func:`swgsim.identify`.

    Attributes
    ----------
    answer : Answer
        The fitted models, the effects and all tests.
    report : mapping
        The content of ``report.json`` in SI units; docs/report_fields.md explains the fields.
    """

    answer: Answer
    report: Mapping[str, Any]

    @property
    def sentence(self) -> str:
        """The verdict in one sentence, in engineering units."""
        return str(self.report["sentence"])

    @property
    def verdict(self) -> str:
        """``nothing_missing``, ``effect_found`` or ``unknown_effect``."""
        return str(self.report["verdict"])

    def table(self) -> "pd.DataFrame":
        """The parameters of the effects that were found.

        Returns
        -------
        DataFrame
            Columns ``effect``, ``parameter`` (in words), ``value``, ``low`` and ``high`` (95 % interval; NaN for
            a parameter that was fixed or chosen from a list), ``unit`` (an engineering unit).
        """
        import pandas as pd

        rows = []
        for effect in self.report["effects"]:
            for name, estimate in effect["parameters"].items():
                value, interval, unit = in_unit(effect["name"], name, estimate)
                low, high = interval or (float("nan"), float("nan"))
                rows.append((effect["name"], parameter_words(effect["name"], name), value, low, high, unit))
        return pd.DataFrame(rows, columns=["effect", "parameter", "value", "low", "high", "unit"])

    def plot_residual(self) -> "Figure":
        """Residual of the gauges over one revolution, without and with the effects that were found."""
        from swgsim.identification.report.answer_figures import over_angle

        return over_angle(self.answer)

    @cached_property
    def pictures(self) -> Mapping[str, "Picture"]:
        """All pictures of the page by name."""
        from swgsim.identification.report import answer_figures  # with matplotlib, which takes a second

        return answer_figures.pictures(self.answer, self.report)

    def save(self, folder: Path | str) -> None:
        """Write ``report.json``, ``effects.yaml`` and ``page.html``; every file is complete or absent.

        Raises
        ------
        OSError
            If the folder cannot be written.
        """
        from swgsim.identification.report.answer_page import page

        found, folder = self.answer, Path(folder)
        interharmonics = (*found.known, *(line.effect for line in found.lines), *found.bare_lines)
        html = page(self.report, self.pictures)
        write_json(folder / "report.json", self.report)
        write_text(folder / "effects.yaml", as_text((*found.decision.after.model.effects, *interharmonics)))
        write_text(folder / "page.html", html)

    def __repr__(self) -> str:
        recordings = self.report["recordings"]
        return (
            f"Identification of {recordings['gear']!r} from {recordings['count']} recordings: {self.sentence}\n"
            f"error at operating points left out: {_percent(self.report['error']['before']['heldout'])} before, "
            f"{_percent(self.report['error']['after']['heldout'])} after"
        )

    def _repr_html_(self) -> str:
        head, *lines = repr(self).splitlines()
        table = self.table()
        shown = table.to_html(index=False, na_rep="", float_format="{:.4g}".format) if len(table) else ""
        return f"<b>{escape(head)}</b><p>{escape(' '.join(lines))}</p>{shown}"


def _percent(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3g} %"
