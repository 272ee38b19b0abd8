"""Measurements as data of the fit: order lines, situations, noise, and errors that recordings share."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from swgsim.identification.data.features import Layout, features, layout_of
from swgsim.identification.data.model import Situation
from swgsim.identification.data.noise import floors, variance
from swgsim.identification.data.repeated import about_mean, groups_of
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Errors of a whole session, as standard deviations: zeros [N m, mV/V], gains, drifts of a zero [mV/V per hour], the
# index of the angle, and that of the gauges against it where a device of its own logs them [rad]. Zeros of gauges as by
# 5 K at 1 uV/V per K; gains as of flanges of class 0.2, and of amplifiers that hold 0.03 % from day to day; drifts are
# an estimate for one that warms up, as is the index of the gauges, 0.1 degree.
OF_SESSION = {
    "zero of T_in": 0.003,
    "zero of T_out": 0.2,
    "gain of T_in": 0.002,
    "gain of T_out": 0.002,
    "index": 0.02,
    "index of gauges": 0.0017,
    **{f"zero of s{sensor}": 0.005 for sensor in range(5)},
    **{f"gain of s{sensor}": 0.0003 for sensor in range(5)},
    **{f"drift of s{sensor}": 0.002 for sensor in range(5)},
}
# Random walk of the zero of a gauge, in addition to its drift, as in a room with unsteady temperature [mV/V per square
# root of an hour, an estimate]; and the share of its variance that the retained paths must explain.
WANDER, LEAST_EXPLAINED_VARIANCE = 0.001, 0.95
# Zeros that lie further off may wander more too, up to this factor (an estimate): balancing moves them only once.
MOST_WANDER = 4.0


@dataclass(frozen=True, eq=False)
class Measured:
    """Recordings as data vectors of order lines.

    Attributes
    ----------
    recordings : tuple of Recording
    layout : Layout
    values : array (recording, feature)
    variance : array (recording, feature)
        Of the noise.
    zeros : float
        Factor on the declared deviation of the zeros of gauges, as after balancing the bridges; it also applies to
        their random walk, up to MOST_WANDER.
    """

    recordings: tuple[Recording, ...]
    layout: Layout
    values: Float[np.ndarray, "recording feature"]
    variance: Float[np.ndarray, "recording feature"]
    zeros: float = 1.0

    @classmethod
    def of(cls, recordings: Sequence[Recording]) -> "Measured":
        """From recordings, with the channels that all of them have."""
        layout = layout_of(recordings)
        values = np.array([features(recording, layout) for recording in recordings])
        noise = variance(recordings, layout, floors(recordings, layout))
        return cls(tuple(recordings), layout, values, noise)

    def __len__(self) -> int:
        return len(self.recordings)

    def further(
        self, session: str, situations: Sequence[Situation], predicted: Float[np.ndarray, "situation feature"]
    ) -> "Measured":
        """Planned recordings of a session, with predicted values and without noise."""
        recordings = tuple(
            Recording(f"planned {i}", "", session, each.point, 1, np.empty(0), {}, each.conditions)
            for i, each in enumerate(situations)
        )
        return Measured(recordings, self.layout, predicted, 0 * predicted, self.zeros)

    @cached_property
    def situations(self) -> tuple[Situation, ...]:
        """Distinct operating points and conditions."""
        return tuple(dict.fromkeys(Situation(r.point, r.conditions) for r in self.recordings))

    @cached_property
    def of_recording(self) -> np.ndarray:
        """Situation of each recording."""
        return np.array([self.situations.index(Situation(r.point, r.conditions)) for r in self.recordings])

    @cached_property
    def turning(self) -> Float[np.ndarray, "recording feature"]:
        """Change of the recorded lines per radian of the angle."""
        return self.layout.turning(self.values)

    @property
    def temperature_recorded(self) -> bool:
        """Whether any recording has another temperature than the one that stands for an unknown one."""
        return any(recording.conditions.warmer for recording in self.recordings)

    @property
    def sessions(self) -> list[str]:
        """In the order in which they were first recorded."""
        return list(dict.fromkeys(r.session for r in self.recordings))

    @property
    def repeats(self) -> list[object]:
        """Session and operating point of each recording: those with the same ones are repeats of each other."""
        return groups_of(self.recordings)

    @property
    def spare(self) -> int:
        """Degrees of freedom of the repeats, which give the noise; 0 without repeats."""
        return len(self) - len(set(self.repeats))

    def about_repeats(self, values: Float[np.ndarray, "recording feature"]) -> Float[np.ndarray, "recording feature"]:
        """Values less their mean over the repeats of each recording."""
        return about_mean(values, self.repeats)

    def rows(self, of_situation: Float[np.ndarray, "situation feature *column"]) -> np.ndarray:
        """Values of situations as rows (recording, feature), one below the other."""
        whole = of_situation[self.of_recording]
        return whole.reshape(whole.shape[0] * whole.shape[1], *whole.shape[2:])

    def point_rows(self) -> list[np.ndarray]:
        """The rows of every operating point, as masks."""
        points = [r.point for r in self.recordings]
        return [np.repeat([p == point for p in points], len(self.layout)) for point in dict.fromkeys(points)]

    def repeat_rows(self) -> list[np.ndarray]:
        """The rows of every recording that has repeats, as masks."""
        repeated = [i for i, each in enumerate(self.repeats) if self.repeats.count(each) > 1]
        return [np.repeat(np.arange(len(self)) == i, len(self.layout)) for i in repeated]

    def session_columns(
        self, predicted: Float[np.ndarray, "situation feature"], known: "Measured | None" = None
    ) -> Float[np.ndarray, "row column"]:
        """Errors that all recordings of a session share, one standard deviation each.

        Parameters
        ----------
        predicted : array (situation, feature)
        known : Measured, optional
            Recordings of the same sessions that determine these errors; by default these recordings.
        """
        known = known or self
        layout = self.layout
        columns = []
        for session in known.sessions:
            here = self._here(session)
            for name, sd in OF_SESSION.items():
                kind, _, channel = name.partition(" of ")
                if kind == "zero" and channel in SENSORS:
                    continue  # which come last
                own = layout.of_gauges if channel == "gauges" else layout.channel == channel
                mean = self._mean_of(channel)
                moved = {
                    "index": self.turning * (own if channel else True),
                    "zero": mean[None, :],
                    "gain": own * predicted[self.of_recording],
                    "drift": self._hours * mean,
                }[kind]
                if own.any() or not channel:
                    columns.append((sd * here * moved).ravel())
        zeros, walks = self._zeros(known)
        return np.hstack([np.stack(columns, axis=1), self.zeros * zeros, _wandering(self.zeros) * walks])

    def further_zeros(self, times: float) -> Float[np.ndarray, "row column"]:
        """What zeros of gauges so many times as far off as declared, no nearer than now, have beyond those of
        :meth:`session_columns`.
        """
        return np.hstack([by * each for by, each in zip(self.beyond_zeros(times), self.free_zeros, strict=True)])

    def beyond_zeros(self, times: float) -> tuple[float, float]:
        """The same as factors on both of :attr:`free_zeros`."""
        wandering = _wandering(times) ** 2 - _wandering(self.zeros) ** 2
        return float(np.sqrt(times**2 - self.zeros**2)), float(np.sqrt(wandering))

    @property
    def free_zeros(self) -> tuple[Float[np.ndarray, "row zero"], Float[np.ndarray, "row path"]]:
        """Zeros of gauges in every session, and the paths by which they wander, as far as declared."""
        return self._zeros(self)

    def _zeros(self, known: "Measured") -> tuple[Float[np.ndarray, "row zero"], Float[np.ndarray, "row path"]]:
        """Zeros of gauges in every session, and the paths by which they wander, one standard deviation each."""
        gauges = [gauge for gauge in SENSORS if gauge in self.layout.channels]
        zeros, walks = [np.zeros((self.values.size, 0))], [np.zeros((self.values.size, 0))]
        for session in known.sessions:
            here = self._here(session)
            known_hours = np.array([r.conditions.elapsed / 3600 for r in known.recordings if r.session == session])
            paths = _walks(known_hours, self._hours * here)
            for gauge in gauges:
                mean = self._mean_of(gauge)
                zeros.append(OF_SESSION[f"zero of {gauge}"] * np.outer(here, mean).reshape(-1, 1))
                walks.append(np.kron(paths, mean).T)
        return np.hstack(zeros), np.hstack(walks)

    @cached_property
    def _hours(self) -> Float[np.ndarray, "recording 1"]:
        """Since the session of each began."""
        return np.array([[r.conditions.elapsed / 3600] for r in self.recordings])

    def _mean_of(self, channel: str) -> Bool[np.ndarray, " feature"]:
        """Which feature is the mean of a channel."""
        return (self.layout.channel == channel) & (self.layout.order == 0)

    def _here(self, session: str) -> Bool[np.ndarray, "recording 1"]:
        """Whether each is of a session."""
        return np.array([[r.session == session] for r in self.recordings])


def _wandering(zeros: float) -> float:
    """Factor on the random walk of zeros, from the factor on their deviation."""
    return min(zeros, MOST_WANDER)


def _walks(
    known_hours: Float[np.ndarray, " one"], hours: Float[np.ndarray, "other 1"]
) -> Float[np.ndarray, "path other"]:
    """Karhunen-Loeve modes of a random walk that is observed at some times, evaluated at other times."""
    values, vectors = np.linalg.eigh(np.minimum.outer(known_hours, known_hours))
    largest = np.argsort(-values)
    beyond = np.cumsum(values[largest]) - values[largest] > LEAST_EXPLAINED_VARIANCE * values.sum()
    kept = largest[~beyond & (values[largest] > 0)]
    return WANDER * (np.minimum(known_hours, hours) @ (vectors[:, kept] / np.sqrt(values[kept]))).T
