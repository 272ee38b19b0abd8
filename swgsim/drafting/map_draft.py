"""A drafted map, which shows itself: as a table, as a picture, and as the YAML file to be corrected."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from swgsim.common.files import replacing, write_text
from swgsim.drafting.clock import ClockDraft
from swgsim.drafting.draft_line import DraftLine

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

WIDEST_COLUMN = 28


@dataclass(frozen=True, eq=False, repr=False)
class MapDraft:
    """A first map or source.

    Attributes
    ----------
    kind : str
        ``gauges`` for a column map, ``joints`` for a source.
    path : Path
        The files that were looked at.
    text : str
        YAML of the map, with comments.
    drafted : tuple of DraftLine
        What each column was taken for.
    clock : ClockDraft or None
    findings : str
        What the reading says of the draft.
    readable : bool
        Whether the draft reads a usable recording as it is.
    """

    kind: str
    path: Path
    text: str
    drafted: tuple[DraftLine, ...]
    clock: ClockDraft | None
    findings: str
    readable: bool

    @property
    def questions(self) -> tuple[str, ...]:
        """Lines that the user must decide."""
        return tuple(line.strip() for line in self.text.splitlines()[1:] if "# ???" in line)

    def table(self) -> "DataFrame":
        """One row for each column: first values, range, what it was taken for, in which unit, and why."""
        from pandas import DataFrame

        rows = [
            {
                "column": " ".join(filter(None, [each.column.file, str(each.column.column)])),
                "first values": each.column.first,
                "range": each.column.range,
                "taken for": " ".join(filter(None, [each.joint, each.quantity])) + "?" * bool(each.question),
                "unit": str(each.entry.get("unit", "")),
                "why": "; ".join(filter(None, [each.why, each.question])),
            }
            for each in self.drafted
            if each.quantity != "gear_ratio"
        ]
        return DataFrame(rows)

    def plot(self) -> "Figure":
        """Each column of numbers against time."""
        from swgsim.drafting.picture import picture  # imports matplotlib, which takes a second

        return picture(self.drafted, self.clock)

    def save(self, path: str | Path) -> None:
        """Write the draft, and its picture beside it as PNG; both are complete or absent.

        Raises
        ------
        ValueError
            If the file exists: it may have been corrected by hand.
        """
        from swgsim.common import style

        path = Path(path)
        if path.exists():
            raise ValueError(f"{path} exists and may have been corrected: choose another file, or remove it")
        write_text(path, self.text)
        with replacing(path.with_suffix(".png")) as aside:
            aside.write_bytes(style.png(self.plot()))

    def __repr__(self) -> str:
        """The table, the lines to decide, and what the reading says."""
        parts = [_aligned(self.table())]
        parts += ["to decide:", *(f"  {line}" for line in self.questions)] if self.questions else ["nothing to decide"]
        return "\n".join([*parts, "read back:", *(f"  {line}" for line in self.findings.splitlines())])


def _aligned(table: "DataFrame") -> str:
    """A table as text, each column as wide as its longest cell, but none wider than :data:`WIDEST_COLUMN`."""
    rows = [list(table.columns), *table.to_numpy().tolist()]
    cells = [[cell if len(cell) <= WIDEST_COLUMN else cell[: WIDEST_COLUMN - 1] + "…" for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(
        "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells
    )
