"""The answer as one HTML page with its pictures inside; its first line is the verdict."""

from collections.abc import Mapping, Sequence
from typing import Any

from swgsim.common import style
from swgsim.common.html import environment


def page(report: Mapping[str, Any], pictures: Sequence[style.Picture]) -> str:
    """The page of a report.

    Parameters
    ----------
    report : mapping
        As :func:`swgsim.identification.report.report_fields.report` makes it.
    pictures : sequence of Picture
    """
    templates = environment("swgsim")
    templates.filters["words"] = style.words
    templates.filters["figure"] = figure
    return templates.get_template("identification/report/answer_page.html.jinja").render(report=report, pictures=pictures)


def figure(value: float | None, digits: int = 3) -> str:
    """A number as people read it.

    >>> figure(0.00012345), figure(None), figure(4810.8), figure(999.7)
    ('0.000123', 'not known', '4811', '1000')
    """
    if value is None:
        return "not known"
    return f"{value:.0f}" if 10**digits - 0.5 <= abs(value) < 1e6 else f"{value:.{digits}g}"
