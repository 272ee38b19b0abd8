"""The answer for a joint as one HTML page with its pictures inside; its first line is the verdict."""

from collections.abc import Mapping, Sequence
from typing import Any

from swgsim.common import style
from swgsim.common.html import environment
from swgsim.common.numbers import significant


def page(said: Mapping[str, Any], pictures: Sequence[style.Picture]) -> str:
    """The page of a report.

    Parameters
    ----------
    said : mapping
        As :func:`swgsim.joint.report.report` makes it, with findings of the files and the time that it took.
    pictures : sequence of Picture
    """
    templates = environment("swgsim")
    templates.filters["words"] = style.words
    templates.filters["figure"] = significant
    templates.filters["capital"] = capital
    return templates.get_template("joint/joint_page.html.jinja").render(said=said, pictures=pictures)


def capital(text: str) -> str:
    """A text with a capital at its beginning, all other letters as they are.

    >>> capital("ripple through the UR10e's filter")
    "Ripple through the UR10e's filter"
    """
    return text[:1].upper() + text[1:]
