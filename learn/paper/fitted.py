"""The kept result of ``make paper-choices``, which the report shows beside that of ``grid=paper``."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files

Cell = tuple[str, str, str]  # table, row and classifier


@dataclass(frozen=True)
class Fitted:
    """What the study of the open choices found.

    Attributes
    ----------
    command : str
        That made the result.
    answer : str
        What the paper's chain has that ours lacks.
    judgement : str
        Whether the tables that the fit never saw support it.
    reading : mapping
        How claims of the paper hold over the choices to those that do, in words.
    remains : list of str
        By what the tables stay away from the paper's.
    samples : int
        Number of sets of choices behind the reading.
    errors : mapping
        Table to its mean absolute difference with the fitted choices [points].
    scores : mapping
        Cell to its score with the fitted choices [%].
    """

    command: str
    answer: str
    judgement: str
    reading: Mapping[str, str]
    remains: list[str]
    samples: int
    errors: Mapping[str, float]
    scores: Mapping[Cell, float]


def fitted() -> Fitted:
    """The kept result."""
    kept = json.loads((files("learn.paper") / "tables" / "paper_choices.json").read_text(encoding="utf-8"))
    scores = {(cell["table"], cell["row"], cell["classifier"]): cell["after"] for cell in kept["cells"]}
    texts = {name: kept[name] for name in ("command", "answer", "judgement", "reading", "remains", "samples")}
    return Fitted(**texts, errors=kept["after"], scores=scores)
