"""One recording of one joint of a robot: motion of the output, torque and motor current."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from swgsim.effects.sense import sense
from swgsim.joint.kinematics import displaced, inertia, jitter, least_doubt, smooth, window


class Signal(NamedTuple):
    """Unit and meaning of a signal."""

    unit: str
    meaning: str


SIGNALS: Mapping[str, Signal] = {
    "q": Signal("rad", "angle of the joint at its output, unwrapped"),
    "omega": Signal("rad/s", "speed of the joint"),
    "T_sensor": Signal("N m", "torque sensor behind the gear"),
    "current": Signal("A", "motor current"),
    "T_motor": Signal("N m", "torque of the motor, as the drive gives it, with the friction of the joint"),
    "T_rigid": Signal("N m", "torque at the output by the controller's rigid-body model, without friction"),
}
# Least share of the way in each direction of a joint that reverses. A joint that creeps in one direction and sticks on
# its way swings back by up to 0.024 of its way; one that is moved to and fro has 0.5.
BACK = 0.05
# Accuracy [rad] with which a joint's angle must agree with an angle of the posture to be the same.
ANGLE_TOLERANCE = 1e-6
# Signals that the model predicts; the others are its inputs.
PREDICTED = ("T_sensor", "current", "T_motor")
# Those of the drive, which the friction of the gear is in.
OF_DRIVE = ("current", "T_motor")


@dataclass(frozen=True, eq=False)
class JointRecording:
    """One recording of one joint.

    Attributes
    ----------
    name : str
        Name of the run, unique within a joint.
    robot, joint : str
    session : str
        Recordings between which nothing was dismounted, such as a day or a trajectory.
    time : array (time,)
        [s], increasing.
    signals : mapping
        Name of :data:`SIGNALS` to array (time,) in its unit; ``q`` and ``omega`` are mandatory.
    posture : array (joint, time)
        Angles [rad] of the joints with parallel level axes, from base to tip, for gravity, if known.
    gear_ratio : float or None
        Revolutions of the motor per revolution of the output, if known.
    torque_constant : float or None
        Torque at the output per ampere [N m/A], if known.
    """

    name: str
    robot: str
    joint: str
    session: str
    time: Float[np.ndarray, " time"]
    signals: Mapping[str, Float[np.ndarray, " time"]]
    posture: Float[np.ndarray, "joint time"] | None = None
    gear_ratio: float | None = None
    torque_constant: float | None = None

    def __post_init__(self) -> None:
        for name in ("q", "omega"):
            if name not in self.signals:
                raise ValueError(f"recording {self.name} has no signal {name}: {SIGNALS[name].meaning} is needed")
        for name, values in self.signals.items():
            if name not in SIGNALS:
                raise ValueError(f"recording {self.name}: unknown signal {name!r}; choose from {', '.join(SIGNALS)}")
            if len(values) != len(self.time):
                raise ValueError(f"recording {self.name}: {len(values)} values of {name} at {len(self.time)} times")
        if self.posture is not None and self.posture.shape[1] != len(self.time):
            raise ValueError(f"recording {self.name}: {self.posture.shape[1]} postures at {len(self.time)} times")

    def __len__(self) -> int:
        return len(self.time)

    @cached_property
    def speed(self) -> Float[np.ndarray, " time"]:
        """Smoothed speed of the joint [rad/s]."""
        return smooth(self.signals["omega"], self.rate, 0)

    @cached_property
    def acceleration(self) -> Float[np.ndarray, " time"]:
        """Acceleration of the joint [rad/s^2], smoothed to the least error.

        In one direction it is that of the speed control. What is faster there is the ripple of the gear, which inertia
        would explain in the fitted runs only.
        """
        omega = self.signals["omega"]
        return least_doubt(omega, self.rate, 1)[0] if self.reverses else smooth(omega, self.rate, 1)

    def later(self, values: Float[np.ndarray, " time"], lag: float) -> Float[np.ndarray, " time"]:
        """Values of the motion, as a signal shows them a time ``lag`` [s] later."""
        return np.interp(self.time - lag, self.time, values) if lag else values

    @cached_property
    def reverses(self) -> bool:
        """Whether the joint moved in both directions."""
        return turns_back([self])

    @cached_property
    def _direct(self) -> tuple[Float[np.ndarray, " time"], float]:
        """Speed that shows the direction best, with its error [rad/s]."""
        return least_doubt(self.signals["omega"], self.rate)

    @property
    def speed_doubt(self) -> float:
        """Speed below which the recording does not show the direction of the motion [rad/s]: the error of the speed,
        and its change within a sample, after which a reversal is seen.
        """
        within = float(np.sqrt(np.mean(self.acceleration**2))) / self.rate / np.sqrt(12)
        return float(np.hypot(self._direct[1], within))

    def sense(self, width: float, lag: float = 0.0) -> Float[np.ndarray, " time"]:
        """Sign of Coulomb friction, from -1 to 1, that changes within a speed ``width`` [rad/s] and a time ``lag`` [s]
        after the motion.

        It is constant for a joint that never reverses.
        """
        if not self.reverses:
            return np.full(len(self), float(np.sign(self.speed.sum())))
        speed, _ = self._direct
        return sense(self.later(speed, lag), width)

    def rest(self, width: float, lag: float = 0.0) -> Float[np.ndarray, " time"]:
        """How far the direction of the motion is unknown, from 0 to 1: the variance of a sign whose mean changes within
        a speed ``width`` [rad/s]. It is 1 where the joint stands, also one that never reverses.
        """
        return 1 - sense(self.later(self._direct[0], lag), max(width, self.speed_doubt)) ** 2

    @cached_property
    def held(self) -> Float[np.ndarray, " time"]:
        """Direction of the last displacement before a standstill, while the joint stands after it; 0 while it moves.

        It stands where its angle stays within its own noise over the window of the smoothing, and around as long as it
        moves no further than the doubt of the speed allows. Noise of the speed, and the swing of a smoothed speed after
        a stop, have no part in it.
        """
        q, size = self.signals["q"], window(len(self), self.rate)
        way, noise = maximum_filter1d(q, size) - minimum_filter1d(q, size), jitter(q, size)
        rests, near = (
            maximum_filter1d(way < least, size) for least in (noise, noise + self.speed_doubt * size / self.rate)
        )
        if not rests.any():
            return np.zeros(len(self))
        change = np.diff(near, prepend=near[0])
        number, starts = np.cumsum(change), np.append(0, np.flatnonzero(change))
        stands = near & (np.bincount(number, rests) > 0)[number]
        return np.where(stands, displaced(q, float(np.median(noise[rests])))[starts][number], 0.0)

    @cached_property
    def inertia(self) -> Float[np.ndarray, " time"] | None:
        """Inertia about the axis of a joint that is not in the posture [kg m^2]; None if it cannot be computed."""
        if self.posture is None or "T_rigid" not in self.signals or len(self.links[0]) > 1:
            return None
        reach = np.cos(np.cumsum(self.posture, axis=0))
        return inertia(reach, self.speed, self.acceleration, self.time, self.signals["T_rigid"])

    @property
    def links(self) -> tuple[Float[np.ndarray, "link time"], int]:
        """Angle of every link about parallel level axes against the first one's base [rad], and the number of the link
        that this joint turns; only its own angle if it is not in the posture or the posture is unknown.
        """
        own = self.signals["q"][None]
        if self.posture is not None:
            same = (np.abs(self.posture - own) < ANGLE_TOLERANCE).all(axis=1)
            if same.any():
                return np.cumsum(self.posture, axis=0), int(same.argmax())
        return own, 0

    def part(self, rows: slice) -> "JointRecording":
        """Some of its samples."""
        signals = {name: values[rows] for name, values in self.signals.items()}
        posture = None if self.posture is None else self.posture[:, rows]
        return replace(self, time=self.time[rows], signals=signals, posture=posture)

    @property
    def rate(self) -> float:
        """Sampling rate [Hz], the mean over the recording."""
        return (len(self.time) - 1) / float(self.time[-1] - self.time[0])


def turns_back(recordings: Iterable[JointRecording]) -> bool:
    """Whether a joint was moved in both directions."""
    speed = np.concatenate([each.speed for each in recordings])
    forwards, backwards = speed[speed > 0].sum(), -speed[speed < 0].sum()
    return bool(min(forwards, backwards) > BACK * (forwards + backwards))
