"""The answer as one HTML page with its pictures inside; its first line is the verdict."""

from collections.abc import Mapping, Sequence
from typing import Any

from swgsim.common import style
from swgsim.common.html import environment
from swgsim.common.numbers import significant


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
    templates.filters["figure"] = significant
    return templates.get_template("identification/report/answer_page.html.jinja").render(report=report, pictures=pictures)
