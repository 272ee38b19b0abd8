"""The textbook model of a joint: load, inertia, Coulomb and viscous friction, and the zero of its sensor."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import PREDICTED, JointRecording, turns_back
from swgsim.joint.regression import LEAST_GAIN, Fit, Table, fit, rms
from swgsim.joint.shared import OfLoad, OfMotion, OfSign, link
from swgsim.joint.sign_width import with_sign_width
from swgsim.joint.term import Term


@dataclass(frozen=True)
class RigidBody(OfLoad, OfMotion):
    """Torque that moves the links: that of the torque sensor, or of the controller's rigid-body model, or without both
    the inertia and gravity of a single link, J domega/dt + c cos q + s sin q.

    A torque sensor behind the gear does not feel the inertia of the motor, which the current drives as well.
    """

    modelled: bool = True
    explains = PREDICTED

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """The load, with the inertia of the motor if it is measured; or three columns of a single link."""
        if self.modelled and not self.measured:
            return self.load(recording)[:, None]
        columns = link(recording, self.lag)
        return np.stack([self.load(recording), columns[:, 0]], axis=1) if self.measured else columns

    def least(self, columns: int) -> Float[np.ndarray, " column"]:
        """Inertia is not negative. The factor of a load may be: it may be counted as the torque of the links."""
        return np.where(["inertia" in name for name in self.names()], 0.0, -np.inf)

    def names(self) -> tuple[str, ...]:
        """Factor of the torque, or the parts of a single link."""
        if self.measured:
            return "factor of the measured torque", "inertia of the motor"
        return ("factor of the rigid-body torque",) if self.modelled else ("inertia", "gravity cosine", "gravity sine")

    def units(self, of: str) -> tuple[str, ...]:
        """Per torque, and of inertia; or of inertia and two torques in the unit of the signal."""
        if self.measured:
            return f"{of}/(N m)", f"{of} s^2/rad"
        return (f"{of}/(N m)",) if self.modelled else (f"{of} s^2/rad", of, of)


@dataclass(frozen=True)
class Friction(OfSign):
    """Coulomb and viscous friction, b0 sign(omega) + b1 omega, as in eq. (5) without its cubic and angular parts."""

    weight_names = ("Coulomb friction", "viscous friction")
    per = ("", " s/rad")

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Sign and speed of the motion."""
        return np.stack([self.sense(recording), self.side * recording.speed], axis=1)

    def least(self, columns: int) -> Float[np.ndarray, " column"]:
        """Friction brakes, or is absent."""
        return np.zeros(columns)


@dataclass(frozen=True)
class Stiction(OfSign):
    """Coulomb friction that holds a joint at rest. It may have any size up to that of the motion; here it has a part of
    it that is the same at every standstill, in the direction of the motion before.
    """

    weight_names = ("Coulomb friction at rest",)

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """Direction of the last motion."""
        return (self.side * recording.held * (1 - np.abs(self.sense(recording))))[:, None]

    def least(self, columns: int) -> Float[np.ndarray, " column"]:
        """It does not drive."""
        return np.zeros(columns)


@dataclass(frozen=True)
class Zero(Term):
    """A constant."""

    def columns(self, recording: JointRecording) -> Float[np.ndarray, "time column"]:
        """A column of ones."""
        return np.ones((len(recording), 1))


def textbook(recordings: tuple[JointRecording, ...], of: str, *, measured: bool = False) -> tuple[Term, ...]:
    """The textbook's terms for a signal, as far as the recordings have the signals that these need.

    The load of a current is the torque behind the gear if ``measured``. A torque sensor does not measure friction of
    the gear, unless the torque of the model is that of the other side of the gear; its zero differs in every run. If no
    joint ever reverses, the zero of a current and Coulomb friction cannot be separated; the zero is then left out.
    """
    modelled = measured or all("T_rigid" in each.signals for each in recordings)
    rigid, back = RigidBody(modelled=modelled, measured=measured), turns_back(recordings)
    rest = (Stiction(),) if back and any(each.held.any() for each in recordings) else ()
    if of == "T_sensor":
        return (rigid, Friction(), *rest) if modelled and back else (rigid,)
    return (rigid, Friction(), *rest, Zero()) if back else (rigid, Friction())


def fitted_textbook(table: Table) -> Fit:
    """The textbook model with the width of the sign, the side of the friction, and the load that predict best.

    The friction is in front of a current. A torque sensor may be on either side of it. The measured torque is the load
    of a current if it predicts the current better than the model does, by as much as an effect must, over all and
    within the runs. A joint without a load shows little but the zero of its sensor, which differs from run to run as
    friction at different speeds does.
    """
    terms = textbook(table.recordings, table.of)
    plain = with_sign_width(fit(table, terms))
    if table.of == "T_sensor":
        other = [replace(term, side=-1) if isinstance(term, OfSign) else term for term in terms]
        return min(plain, with_sign_width(fit(table, other)), key=lambda each: each.error)
    if not all("T_sensor" in each.signals for each in table.recordings):
        return plain
    measured = with_sign_width(fit(table, textbook(table.recordings, table.of, measured=True)))
    return measured if (_errors(measured) < (1 - LEAST_GAIN) * _errors(plain)).all() else plain


def with_link(found: Fit) -> Fit:
    """The model whose single link is the load of the effects, if the recordings determine it: its torque is larger than
    the intervals of its weights allow for. A joint that moves near one angle does not tell gravity from its zero.
    """
    rigid, *others = found.terms
    if not isinstance(rigid, RigidBody) or rigid.modelled:
        return found
    columns, number = found.X, len(rigid.weights)
    torque = float(np.mean((columns[:, :number] @ np.array(rigid.weights)) ** 2))
    doubt = float((found.half_interval**2 * np.mean(columns**2, axis=0))[:number].sum())
    return replace(found, terms=(replace(rigid, link=rigid.weights), *others)) if doubt < torque else found


def _errors(found: Fit) -> Float[np.ndarray, " error"]:
    """Cross-validated error over all, and without the mean of each run."""
    return np.array([rms(found.unseen), rms(found.unseen - found.table.means_of_runs(found.unseen[:, None])[:, 0])])


def unphysical(found: Fit) -> Fit:
    """A model with all signs free, and in a torque sensor the friction of the gear, which it cannot measure.

    What this explains and the model does not is explained by no joint: the signals are not what they are taken for.
    """
    table = found.table
    open_ = table.of == "T_sensor" and turns_back(table.recordings)
    more = (Friction(),) if open_ and not any(isinstance(term, Friction) for term in found.terms) else ()
    return fit(table, (*found.terms, *more), bounded=False)


def wrong_signs(textbook: Fit, unit: str) -> Iterator[str]:
    """Weights of the textbook that would have a sign that physics forbids if they were free, in words."""
    free = fit(textbook.table, textbook.terms, bounded=False)
    start = 0
    for term in free.terms:
        units = term.units(unit)
        for place, (name, weight) in enumerate(zip(term.names(), term.weights, strict=True)):
            least = float(term.least(len(term.weights))[place])
            half = float(free.half_interval[start + place])
            if weight + half < least:
                yield f"{name} ({weight:.2g} ± {half:.1g} {units[place % len(units)]})"
        start += len(term.weights)
