"""One recording with every channel that a test bench delivers, and the facts that belong to it."""

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
    """Name of the column in a file, unit, and what it says."""

    column: str
    unit: str
    says: str


CHANNELS: Mapping[str, Channel] = {
    "phi_in": Channel("phi_in_rad", "rad", "angle of the wave generator relative to the flex spline"),
    "n_in": Channel("n_in_rpm", "rpm", "speed of the wave generator"),
    "T_in": Channel("T_in_nm", "N m", "torque at the input"),
    "T_out": Channel("T_out_nm", "N m", "torque at the output"),
    **{sensor: Channel(f"{sensor}_mv_v", "mV/V", f"strain-gauge bridge {sensor}") for sensor in SENSORS},
}


@dataclass(frozen=True)
class Recording:
    """One recording of one gear at one operating point.

    Attributes
    ----------
    name : str
    gear : str
        Which gear, as its owner calls it.
    session : str
        Recordings between which nothing was taken apart.
    point : OperatingPoint
        As it was set.
    repeat : int
        Number of the recording among those of its session and operating point.
    time : array (time,)
        [s], evenly spaced.
    channels : mapping
        Name of :data:`CHANNELS` to array (time,) in the channel's unit; a channel that is not there is not there.
    conditions : Conditions
    label : str
        Condition of the gear, empty if unknown.
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
    def numbers(self) -> str:
        """Digest of the channels, which a copy under another name shares."""
        digest = hashlib.sha256()
        for name in sorted(self.channels):
            digest.update(name.encode() + self.channels[name].tobytes())
        return digest.hexdigest()
