"""Result of an identification of a gear or a robot joint: verdict, report and pictures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from swgsim.common.style import Picture

NOTHING, FOUND, UNKNOWN = "nothing_missing", "effect_found", "unknown_effect"


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of an identification with the recordings of a folder.

    Attributes
    ----------
    report : mapping
        Content of ``report.json``.
    pictures : mapping
        Pictures of the page by name.
    digest : str
        SHA-256 of the recordings.
    """

    report: Mapping[str, Any]
    pictures: Mapping[str, "Picture"]
    digest: str
