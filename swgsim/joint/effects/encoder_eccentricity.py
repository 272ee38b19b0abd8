"""Effect: an angle that is read wrong once per revolution."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import solved
from swgsim.joint.term import Term


@dataclass(frozen=True)
class EncoderEccentricity(Term):
    """The disc of the output's encoder sits off its axis: the angle is read as q + e cos(q + phi), and the
    controller's rigid-body torque is that of another angle. To the first order the load differs by e times its slope
    over the angle, dT/dq (A cos q + B sin q).

    The slope is that of gravity: the rigid-body torque as a sum of waves of the angles of the links, of which this
    joint turns its own and those beyond. The speed read is wrong by the share e sin(q + phi), and viscous friction with
    it, by a thousandth for a large e of 1 mrad.

    Signature: a residual of two waves per revolution where a joint lifts one link, which is then a ripple of order 2 as
    well; told from it by links beyond that move, or by another payload. Waves of order n get neighbours of order n - 1
    and n + 1, which are found as such.
    """

    explains = ("current", "T_sensor")
    needs = ("q", "T_rigid")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Slope of the load times cosine and sine of the angle."""
        angles, own = recording.links
        waves = np.concatenate([np.cos(angles), np.sin(angles)])
        X = np.vstack([waves, recording.acceleration, np.ones(len(recording))]).T
        a, b = np.split(solved(X, recording.signals["T_rigid"])[: len(waves)], 2)
        slope = b[own:] @ np.cos(angles[own:]) - a[own:] @ np.sin(angles[own:])
        q = recording.signals["q"]
        return np.stack([slope * np.cos(q), slope * np.sin(q)], axis=1)

    def units(self, of: str) -> tuple[str, ...]:
        """Of e times the signal of one newton metre."""
        return (f"{of} rad/(N m)",)
