"""Conditions of a recording besides speed and load: temperature, time since the session began."""

from dataclasses import dataclass

from swgsim.common.checks import require

# At which the parameters of a gear hold [degC].
REFERENCE_TEMPERATURE = 25.0


@dataclass(frozen=True)
class Conditions:
    """Conditions of one recording.

    Attributes
    ----------
    temperature : float
        Of the gear [degC].
    elapsed : float
        Time since the session began [s].
    """

    temperature: float = REFERENCE_TEMPERATURE
    elapsed: float = 0.0

    def __post_init__(self) -> None:
        require("the conditions", "temperature", self.temperature, low=-60, high=150)
        require("the conditions", "elapsed", self.elapsed, low=0, high=1e8)

    @property
    def warmer(self) -> float:
        """Temperature above the one at which the gear's parameters hold [K]."""
        return self.temperature - REFERENCE_TEMPERATURE
