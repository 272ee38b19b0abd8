"""The kept result of ``make paper-choices``, which the report shows beside that of ``grid=paper``."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

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
        Which tables come nearer by the fit.
    conclusions : mapping
        How often conclusions of the paper hold over the choices, to those that do, in words.
    remains : list of str
        By what the tables stay away from the paper's.
    samples : int
        Number of sets of choices behind the conclusions.
    claims : mapping
        C1 to C18 to ``share`` of the sets, its ``interval``, and ``reading``.
    found : list of str
        The choices that differ from those of grid=paper.
    errors : mapping
        Table to its mean absolute difference with the fitted choices [points].
    scores : mapping
        Cell to its score with the fitted choices [%].
    """

    command: str
    answer: str
    judgement: str
    conclusions: Mapping[str, Sequence[str]]
    remains: list[str]
    samples: int
    claims: Mapping[str, Mapping[str, Any]]
    found: list[str]
    errors: Mapping[str, float]
    scores: Mapping[Cell, float]

    def words(self, claim: str) -> str:
        """How often a claim holds over the choices.

        >>> fitted().words("C2")
        '0 % (0 to 11), never'
        """
        kept = self.claims[claim]
        share, low, high = (round(100 * each) for each in (kept["share"], *kept["interval"]))
        return f"{share} % ({low} to {high}), {kept['reading'].replace('_', ' ')}"


def fitted() -> Fitted:
    """The kept result."""
    kept = json.loads((files("learn.paper") / "tables" / "paper_choices.json").read_text(encoding="utf-8"))
    scores = {(cell["table"], cell["row"], cell["classifier"]): cell["after"] for cell in kept["cells"]}
    names = ("command", "answer", "judgement", "conclusions", "remains", "samples", "claims", "found")
    return Fitted(**{name: kept[name] for name in names}, errors=kept["after"], scores=scores)
