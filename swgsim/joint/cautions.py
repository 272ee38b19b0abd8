"""What a reader of an answer must know: limits of the model and of the recordings, and what to record next."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from swgsim.common.numbers import significant
from swgsim.joint.days import Days
from swgsim.joint.naming import listed
from swgsim.joint.recording import OF_DRIVE, SIGNALS
from swgsim.joint.shared import OfFriction
from swgsim.joint.sign_width import LONGEST_LAG, at_longest
from swgsim.joint.textbook import RigidBody, unphysical, wrong_signs
from swgsim.joint.validation import Validation
from swgsim.joint.verdict import fails

# p-value below which sessions differ in friction.
DIFFERENT = 0.02
# No strain wave gear has a smaller ratio.
LEAST_GEAR_RATIO = 30
# Angles of held-out recordings beyond the fitted ones, as a share of their samples, that make gravity a guess.
EXTRAPOLATED_SHARE = 0.5


def cautions(validation: Validation, left_out: Sequence[str]) -> list[str]:
    """Limits of the model and of the recordings."""
    unit = SIGNALS[validation.table.of].unit
    found = [f"not used: {each}" for each in left_out if not each.endswith("without=")]
    if validation.table.of in OF_DRIVE and not _load(validation).measured and _measured(validation):
        found.append("T_sensor predicts the current no better than the model without it, and is not used as its load")
    if not _load(validation).modelled:
        found.append(
            "there is no rigid-body torque (T_rigid), so the textbook model has the inertia and gravity of a single "
            "link; for a joint that carries several links, map T_rigid in the source"
        )
    if validation.ladder.unsearched:
        found.append(f"not searched, needs T_rigid: {listed(validation.ladder.unsearched, None)}")
    for each in wrong_signs(validation.ladder.textbook, unit):
        found.append(
            f"{each} of the textbook model would be negative, which is impossible, so it is zero: something else makes "
            "that part of the signal; check the signs of speed, current and torque in the source"
        )
    # Samples farther apart do not show a lag.
    if at_longest(_load(validation).lag) and validation.table.recordings[0].rate * LONGEST_LAG > 1:
        found.append(
            f"the lag between the motion and {validation.table.of} is at its bound of {1e3 * LONGEST_LAG:g} ms: "
            "friction that builds up over a distance looks like a lag, and so do signals with different times; check "
            "the clock of the signals"
        )
    found += _sides(validation)
    found += _small(validation)
    return found


def likely(validation: Validation) -> list[str]:
    """Causes that are likely where a model does not describe the recordings."""
    of = validation.table.of
    found = [f"the unit, the sign, or the side of the gear (motor or output) of q, omega or {of} in the source"]
    load, textbook = _load(validation), validation.ladder.textbook
    if wrong := ", ".join(wrong_signs(textbook, SIGNALS[of].unit)):
        found.insert(
            0,
            f"an opposite sign: {wrong} would be negative. Set inverted: true for {of}, or for q and omega, or remove "
            "it; or the load is that of the other side of the gear",
        )
    added = unphysical(textbook).terms[len(textbook.terms) :]
    if added and added[0].weights[0] > 0:
        found.insert(
            0,
            f"{of} has the friction of the gear in it ({significant(added[0].weights[0])} N m turn with the motion): "
            "then it is the torque of the motor, map it as T_motor; else map T_rigid",
        )
    if not load.modelled:
        also = "" if of == "T_sensor" else " or T_sensor"
        found.append(f"a load that a single link does not have: map T_rigid{also}")
        if validation.table.recordings[0].posture is None:
            found.append("other joints that moved: their posture is not mapped")
        if _elsewhere(validation) > EXTRAPOLATED_SHARE:
            found.append("gravity: the held-out recordings are at angles that the fitted ones did not reach")
    if list(_small(validation)):
        found.append("too small a motion to determine the load")
    return found


def next_experiment(validation: Validation, days: Days | None) -> dict[str, Any] | None:
    """The next recordings that would answer an open question."""
    wishes = []
    if fails(validation):
        wishes.append("check " + "; ".join(likely(validation)))
    if validation.ladder.steps and not validation.helps:
        wishes.append("fit more sessions, such as the held-out ones: they differ from the fitted ones")
    if differ(days):
        wishes.append("log the temperature of the joint, and record one session cold and warm on the same day")
    if days and days.chance is None:
        wishes.append(
            "record three runs or more in each session, to decide whether their speed-dependent friction differs (by "
            f"{100 * days.spread:.0f} % here)"
        )
    if validation.floor is None:
        wishes.append("record the joint at rest, for the noise of its signals")
    undecided = [r.trial.term for r in validation.rungs if r.trial and not r.kept and r.trial.unsteady]
    if undecided:
        ratio = validation.table.recordings[0].gear_ratio
        wishes.append(f"record more sessions, to decide about {listed(undecided, ratio)}")
    return {"words": "; ".join(wishes)} if wishes else None


def differ(days: Days | None) -> bool:
    """Whether the friction of the sessions certainly differs."""
    return days is not None and days.chance is not None and days.chance < DIFFERENT


def _load(validation: Validation) -> RigidBody:
    return next(term for term in validation.ladder.textbook.terms if isinstance(term, RigidBody))


def _measured(validation: Validation) -> bool:
    return all("T_sensor" in each.signals for each in validation.table.recordings)


def _sides(validation: Validation) -> Iterator[str]:
    """Loads and friction on another side of the gear than usual."""
    textbook = validation.ladder.textbook
    load = _load(validation)
    if load.modelled and load.weights[0] + float(textbook.half_interval[0]) < 0:
        yield f"the load counts against the signal ({load.names()[0]} is negative): one of them has the opposite sign"
    friction = next((term for term in textbook.terms if isinstance(term, OfFriction)), None)
    if validation.table.of == "T_sensor" and friction is not None:
        start = len(load.weights)
        if friction.weights[0] > float(textbook.half_interval[start]):
            side, size = "motor" if friction.side < 0 else "output", significant(friction.weights[0])
            yield (
                f"there is Coulomb friction of {size} N m between T_rigid and the torque sensor: T_rigid is the torque "
                f"on the {side}'s side of it"
            )


def _small(validation: Validation) -> Iterator[str]:
    """What recordings cannot tell that move by less than a revolution of the motor."""
    recordings = (*validation.table.recordings, *validation.heldout.recordings)
    way = 2 * np.pi / (recordings[0].gear_ratio or LEAST_GEAR_RATIO)
    spans = [float(np.ptp(each.signals["q"])) for each in recordings]
    small = [span for span in spans if span < way]
    if small:
        yield (
            f"{len(small)} of {len(recordings)} recordings move by {max(small):.2g} rad or less, which is less than a "
            f"revolution of the motor ({way:.2g} rad): they show friction and hysteresis, but no wave of the motor, "
            "and gravity near one angle only"
        )


def _elsewhere(validation: Validation) -> float:
    """Share of the held-out samples at angles beyond those of the fitted recordings."""
    fitted, held = (
        np.concatenate([each.signals["q"] for each in table.recordings])
        for table in (validation.table, validation.heldout)
    )
    return float(((held < fitted.min()) | (held > fitted.max())).mean())
