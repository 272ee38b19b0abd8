"""One recording: the channels that a test bench measures, and the facts that belong to them."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.storage.labelled_signals import SENSORS


class Channel(NamedTuple):
    """Name of the column in a file, unit, and meaning."""

    column: str
    unit: str
    meaning: str


CHANNELS: Mapping[str, Channel] = {
    "phi_in": Channel("phi_in_rad", "rad", "angle of the wave generator relative to the flex spline"),
    "n_in": Channel("n_in_rpm", "rpm", "speed of the wave generator"),
    "T_in": Channel("T_in_nm", "N m", "torque at the input"),
    "T_out": Channel("T_out_nm", "N m", "torque at the output"),
    **{sensor: Channel(f"{sensor}_mv_v", "mV/V", f"strain-gauge bridge {sensor}") for sensor in SENSORS},
}


@dataclass(frozen=True, repr=False)
class Recording:
    """One recording of one gear at one operating point.

    Attributes
    ----------
    name : str
    gear : str
        Name that its owner gave it.
    session : str
        Name of the session; within it nothing was taken apart and no bridge was balanced.
    point : OperatingPoint
        Set points of speed and load.
    repeat : int
        Number of the recording within its session and operating point.
    time : array (time,)
        [s], evenly spaced.
    channels : mapping
        Name of :data:`CHANNELS` to array (time,) in the channel's unit; channels that were not recorded are absent.
    conditions : Conditions
    label : str
        Condition of the gear, empty if unknown.
    lost : int
        Samples that were left out knowingly, as their readings were lost.

    Raises
    ------
    ValueError
        If a channel is unknown or has another length than the time.
    """

    name: str
    gear: str
    session: str
    point: OperatingPoint
    repeat: int
    time: Float[np.ndarray, " time"]
    channels: Mapping[str, Float[np.ndarray, " time"]]
    conditions: Conditions = field(default_factory=Conditions)
    label: str = ""
    lost: int = 0

    def __post_init__(self) -> None:
        unknown = [name for name in self.channels if name not in CHANNELS]
        if unknown:
            raise ValueError(
                f"recording {self.name}: unknown channel {unknown[0]!r}; choose from {', '.join(CHANNELS)}"
            )
        for name, values in self.channels.items():
            if len(values) != len(self.time):
                raise ValueError(f"recording {self.name}: {len(values)} values of {name} at {len(self.time)} times")

    @property
    def rate(self) -> float:
        """Sampling rate [Hz]."""
        return (len(self.time) - 1) / float(self.time[-1] - self.time[0])

    @property
    def duration(self) -> float:
        """Length [s]."""
        return len(self.time) / self.rate

    def __repr__(self) -> str:
        return (
            f"Recording({self.name!r}: gear {self.gear}, session {self.session}, {self.point.n_in_rpm:g} rpm, "
            f"{self.point.T_out:g} N m, repeat {self.repeat}, {self.duration:.3g} s at {self.rate:.4g} Hz, "
            f"{' '.join(self.channels)})"
        )

    @property
    def numbers(self) -> str:
        """Digest of the channels; a copy under another name has the same."""
        digest = hashlib.sha256()
        for name in sorted(self.channels):
            digest.update(name.encode() + self.channels[name].tobytes())
        return digest.hexdigest()
