"""What closing the loop gives, for gears and for robot joints alike: a verdict, a report and its pictures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NOTHING, FOUND, UNKNOWN = "nothing_missing", "effect_found", "unknown_effect"


@dataclass(frozen=True, eq=False)
class Outcome:
    """What closing the loop on a folder gave.

    Attributes
    ----------
    report : mapping
        ``report.json``.
    figures : mapping
        The pictures of the page by name.
    digest : str
        Of the recordings.
    """

    report: Mapping[str, Any]
    figures: Mapping[str, "Figure"]
    digest: str
