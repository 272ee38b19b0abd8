"""Errors per channel, before and after, beside the noise floor."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from swgsim.loop.errors import errors, per_channel
from swgsim.loop.fitted import Fitted
from swgsim.loop.reporting.numbers import number
from swgsim.loop.session import Measured
from swgsim.recording import CHANNELS

UNIT = "% of the root mean square of each channel, root mean square over the channels"


@dataclass(frozen=True, eq=False)
class Sizes:
    """Errors per channel beside what makes them comparable.

    Attributes
    ----------
    channels : tuple of str
    scale : array (channel,)
        Root mean square of each channel, in its unit.
    """

    channels: tuple[str, ...]
    scale: Float[np.ndarray, " channel"]

    @classmethod
    def of(cls, measured: Measured) -> "Sizes":
        """Of recordings."""
        return cls(measured.layout.channels, per_channel(measured, measured.values.ravel()))

    def overall(self, error: Float[np.ndarray, " channel"]) -> float | None:
        """One figure for all channels [UNIT]; None where it is not known."""
        return number(100 * float(np.sqrt(np.mean((error / self.scale) ** 2))))

    def named(self, error: Float[np.ndarray, " channel"]) -> dict[str, float | None]:
        """The error of every channel by its name, in the channel's unit."""
        return {name: number(value) for name, value in zip(self.channels, error.tolist(), strict=True)}


def heldout(before: Fitted, after: Fitted) -> dict[str, float | None]:
    """Errors of both at recorded operating points, each by the model fitted to the others, as the report has them."""
    sizes = Sizes.of(before.measured)
    return {name: sizes.overall(errors(each, after).heldout) for name, each in (("before", before), ("after", after))}


def error(before: Fitted, after: Fitted, floor: Float[np.ndarray, " channel"], sizes: Sizes) -> dict[str, Any]:
    """Errors before and after, of what was fitted and of operating points left out."""
    found = {"before": errors(before, after), "after": errors(after, after)}
    return {
        **{
            name: {"fit": sizes.overall(each.fit), "heldout": sizes.overall(each.heldout)}
            for name, each in found.items()
        },
        "noise_floor": sizes.overall(floor),
        "unit": UNIT,
        "per_channel": {
            channel: {
                **{
                    name: {"fit": number(each.fit[i]), "heldout": number(each.heldout[i])}
                    for name, each in found.items()
                },
                "noise_floor": number(floor[i]),
                "root_mean_square": number(sizes.scale[i]),
                "unit": CHANNELS[channel].unit,
            }
            for i, channel in enumerate(sizes.channels)
        },
    }
