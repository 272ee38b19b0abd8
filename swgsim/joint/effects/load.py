"""Effects: errors of the load that the rigid-body model gives, and of the answer to it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import PREDICTED, JointRecording
from swgsim.joint.regression import solved
from swgsim.joint.shared import OfLoad, OfMotion
from swgsim.joint.term import Term


@dataclass(frozen=True)
class GravityError(Term):
    """A payload, a cable or a centre of gravity that the rigid-body model does not contain: cosine and sine of the
    angle of every link about parallel level axes (exact for a planar chain).

    If the joint is not one of these axes, or the posture is unknown: cosine and sine of its own angle.

    Signature: a residual that depends on the posture only, in both directions and at all speeds.
    """

    explains = PREDICTED
    needs = ("q", "T_rigid")
    of_model = True

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Cosine and sine of the angle of each link against the first one's base."""
        angles, _ = recording.links
        return np.concatenate([np.cos(angles), np.sin(angles)]).T

    def names(self) -> tuple[str, ...]:
        """One cosine and one sine for each link."""
        links = range(1, len(self.weights) // 2 + 1)
        return tuple(f"{wave} of link {link}" for wave in ("cosine", "sine") for link in links)


@dataclass(frozen=True)
class InertiaError(OfMotion):
    """Inertia that the rigid-body model does not contain, J domega/dt: the motor's, seen through the gear, or that of a
    payload (eq. (1)).
    """

    needs = ("omega", "T_rigid")
    of_model = True
    per = (" s^2/rad",)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The acceleration."""
        return recording.later(recording.acceleration, self.lag)[:, None]


@dataclass(frozen=True)
class LoadCurve(OfLoad):
    """A signal that is not in proportion to the load, a T |T| + b T^3: saturated iron, a nonlinear bridge (an estimate
    of form).

    Signature: a residual in phase with the load, in both directions.
    """

    explains = PREDICTED
    needs = ()
    weight_names = ("quadratic coefficient", "cubic coefficient")
    per = ("/(N m)^2", "/(N m)^3")

    def possible(self, recording: JointRecording) -> bool:
        """Whether the load was recorded: its curve and that of a fitted one are the same."""
        return self.signal_of_load in recording.signals

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Second and third power of the load."""
        load = self.load(recording)
        return np.stack([load * np.abs(load), load**3], axis=1)


@dataclass(frozen=True)
class EncoderEccentricity(Term):
    """The disc of the output's encoder sits off its axis. The measured angle is q + e cos(q + phi), so the controller
    computes the rigid-body torque at a wrong angle. To the first order the load error is e cos(q + phi) times the slope
    of the load over the angle, dT/dq (A cos q + B sin q).

    The slope is that of gravity: the rigid-body torque as a sum of waves of the angles of the links. This joint turns
    its own link and those beyond it. The measured speed has a relative error of e sin(q + phi), and viscous friction
    too: a thousandth for a large e of 1 mrad.

    Signature: two waves per revolution where a joint lifts one link; the same as a ripple of order 2, unless links
    beyond the joint move or the payload changes. Waves of order n get neighbours of order n - 1 and n + 1.
    """

    explains = PREDICTED
    needs = ("q", "T_rigid")
    of_model = True
    of_whole = True
    weight_names = ("cosine part", "sine part")
    per = (" rad/(N m)",)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Slope of the load times cosine and sine of the angle."""
        angles, own = recording.links
        waves = np.concatenate([np.cos(angles), np.sin(angles)])
        X = np.vstack([waves, recording.acceleration, np.ones(len(recording))]).T
        a, b = np.split(solved(X, recording.signals["T_rigid"])[: len(waves)], 2)
        slope = b[own:] @ np.cos(angles[own:]) - a[own:] @ np.sin(angles[own:])
        q = recording.signals["q"]
        return np.stack([slope * np.cos(q), slope * np.sin(q)], axis=1)
