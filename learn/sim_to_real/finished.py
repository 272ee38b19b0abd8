"""What is kept of one undeclared effect."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd


@dataclass(frozen=True, eq=False)
class Finished:
    """What is kept of one undeclared effect.

    Attributes
    ----------
    name : str
    hidden : list
        The effect as text.
    loop : mapping
        What the loop said: ``verdict``, ``sentence``, ``found`` (effects as text), ``rivals`` and ``absorbed``
        (names), ``error``.
    scores : DataFrame
        Of :func:`learn.sim_to_real.scores.scores`.
    """

    name: str
    hidden: list[dict[str, Any]]
    loop: Mapping[str, Any]
    scores: pd.DataFrame
