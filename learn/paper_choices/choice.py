"""A choice that the paper leaves open: its range and the prior of its value."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.stats import truncnorm

from swgsim.common.checks import require, require_known

SCALES = ("log", "linear", "yes_no")


@dataclass(frozen=True)
class Choice:
    """One choice (conf/paper_choices.yaml).

    The prior is a normal distribution about the value of ``grid=paper``, on the scale of the choice, cut at the ends of
    the plausible range, which is four standard deviations wide. Yes and no are equally plausible.

    Attributes
    ----------
    name, unit, meaning, source : str
    usual : float
        The value of ``grid=paper``.
    low, high : float
        Ends of the plausible range.
    scale : {"log", "linear", "yes_no"}
    integer : bool
        Whether the value is a number of something.
    fitted : bool
        Whether Tables VII and IX depend on it. If not, the optimiser keeps the usual value.

    Raises
    ------
    ValueError
        If the scale is unknown or the usual value is not within the range.
    """

    name: str
    usual: float
    low: float
    high: float
    unit: str
    meaning: str
    source: str
    scale: str = "log"
    integer: bool = False
    fitted: bool = True

    def __post_init__(self) -> None:
        require_known("the scales of choices", [self.scale], SCALES)
        if not self.low < self.high:
            raise ValueError(f"choice {self.name}: low {self.low} is not below high {self.high}; swap them")
        require(f"choice {self.name}", "usual", self.usual, low=self.low, high=self.high)

    def value(self, share: float) -> float:
        """The value below which a share of the prior lies.

        >>> mass = Choice("mass", usual=1.0, low=0.1, high=10.0, unit="kg", meaning="", source="")
        >>> round(mass.value(0.5), 9), round(mass.value(1.0), 9)
        (1.0, 10.0)
        """
        if self.scale == "yes_no":
            return float(share < 0.5)
        value = float(np.clip(self._back(self._prior.ppf(share)), self.low, self.high))
        return float(round(value)) if self.integer else value

    def share(self, value: float) -> float:
        """The share of the prior below a value."""
        if self.scale == "yes_no":
            return 0.25 if value else 0.75
        return float(self._prior.cdf(self._to(value)))

    def cost(self, value: float) -> float:
        """How much less plausible than the usual value it is: the difference of the logarithms of the prior."""
        return 0.0 if self.scale == "yes_no" else 0.5 * self.deviation(value) ** 2

    def deviation(self, value: float) -> float:
        """Distance from the usual value in standard deviations of the prior."""
        if self.scale == "yes_no":
            return 1.0 if value else -1.0
        return float((self._to(value) - self._to(self.usual)) / self._width)

    def _to(self, value: float) -> float:
        return float(np.log(value)) if self.scale == "log" else value

    def _back(self, value: float) -> float:
        return float(np.exp(value)) if self.scale == "log" else value

    @property
    def _width(self) -> float:
        return (self._to(self.high) - self._to(self.low)) / 4

    @cached_property
    def _prior(self) -> Any:
        usual, width = self._to(self.usual), self._width
        ends = [(self._to(end) - usual) / width for end in (self.low, self.high)]
        return truncnorm(*ends, loc=usual, scale=width)
