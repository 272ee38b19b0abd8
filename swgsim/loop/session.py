"""What was measured, made ready for the loop: features, situations, noise, and the errors that recordings share."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.loop.features import ORDERS, Layout, features, layout_of
from swgsim.loop.model import Situation
from swgsim.loop.noise import floors, variance
from swgsim.recording import Recording

# Errors of a whole session, as standard deviations: zeros [N m, mV/V], the index of the angle [rad].
OF_SESSION = {
    "zero of T_in": 0.003,
    "zero of T_out": 0.2,
    "index": 0.02,
    **{f"zero of s{sensor}": 0.002 for sensor in range(5)},
}


@dataclass(frozen=True, eq=False)
class Measured:
    """Recordings as the loop sees them.

    Attributes
    ----------
    recordings : tuple of Recording
    layout : Layout
    values : array (recording, feature)
    variance : array (recording, feature)
        Of the noise.
    """

    recordings: tuple[Recording, ...]
    layout: Layout
    values: Float[np.ndarray, "recording feature"]
    variance: Float[np.ndarray, "recording feature"]

    @classmethod
    def of(cls, recordings: Sequence[Recording]) -> "Measured":
        """From recordings, with the channels that all of them have."""
        layout = layout_of(recordings)
        values = np.array([features(recording, layout) for recording in recordings])
        noise = variance(recordings, layout, floors(recordings, layout))
        return cls(tuple(recordings), layout, values, noise)

    def __len__(self) -> int:
        return len(self.recordings)

    @cached_property
    def situations(self) -> tuple[Situation, ...]:
        """Distinct operating points and conditions."""
        return tuple(dict.fromkeys(Situation(r.point, r.conditions) for r in self.recordings))

    @cached_property
    def of_recording(self) -> np.ndarray:
        """Situation of each recording."""
        return np.array([self.situations.index(Situation(r.point, r.conditions)) for r in self.recordings])

    @property
    def repeats(self) -> list[object]:
        """Session and operating point of each recording: those with the same ones are repeats of each other."""
        return [(r.session, r.point) for r in self.recordings]

    def rows(self, of_situation: Float[np.ndarray, "situation feature *column"]) -> np.ndarray:
        """What belongs to situations, as rows (recording, feature), one below the other."""
        whole = of_situation[self.of_recording]
        return whole.reshape(whole.shape[0] * whole.shape[1], *whole.shape[2:])

    def point_rows(self) -> list[np.ndarray]:
        """The rows of every operating point, as masks."""
        points = [r.point for r in self.recordings]
        return [np.repeat([p == point for p in points], len(self.layout)) for point in dict.fromkeys(points)]

    def session_columns(self, predicted: Float[np.ndarray, "situation feature"]) -> Float[np.ndarray, "row column"]:
        """Errors that all recordings of a session share, one standard deviation each."""
        turned = self.layout.vector(1j * np.arange(ORDERS + 1) * self.layout.lines(predicted))[self.of_recording]
        columns = []
        for session in dict.fromkeys(r.session for r in self.recordings):
            here = np.array([r.session == session for r in self.recordings])[:, None]
            for name, sd in OF_SESSION.items():
                channel = name.removeprefix("zero of ")
                if name == "index":
                    columns.append((sd * here * turned).ravel())
                elif channel in self.layout.channels:
                    mean = (self.layout.channel == channel) & (self.layout.order == 0)
                    columns.append((sd * here * mean[None, :]).ravel())
        return np.stack(columns, axis=1)
