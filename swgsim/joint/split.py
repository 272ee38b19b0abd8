"""Selection of the recordings to fit and of the held-out recordings."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from swgsim.joint.intake.read import JointRecordings
from swgsim.joint.recording import PREDICTED, SIGNALS, JointRecording
from swgsim.joint.regression import SLOW, Table
from swgsim.joint.validation import noise_floor, standing_noise

# A joint must move by this angle [rad], 0.3 degrees: several times the lost motion of a strain wave gear, so that
# friction reverses. What motions below a revolution of the motor do not show is a caution of the answer.
LEAST_WAY = 0.005

Patterns = str | Sequence[str] | None


@dataclass(frozen=True, eq=False)
class Case:
    """Recordings of one joint, selected for one identification.

    Attributes
    ----------
    table, heldout : Table
        Recordings to fit, and held-out recordings.
    floor : float or None
        Noise of the signal at rest, in its unit.
    floor_how : str
        Origin of this noise, in words; empty if it is unknown.
    left_out : tuple of str
        Names of unused and of refused recordings, each with the reason.
    """

    table: Table
    heldout: Table
    floor: float | None
    floor_how: str
    left_out: tuple[str, ...]


def select(
    files: JointRecordings, judging: JointRecordings | None, joint: str | None, signal: str | None,
    holdout: Patterns, without: Patterns,
) -> Case:  # fmt: skip
    """Select recordings.

    Parameters
    ----------
    files : JointRecordings
    judging : JointRecordings or None
        Held-out recordings from a folder of their own; None if ``holdout`` names them.
    joint, signal : str or None
        Needed if there are several.
    holdout, without : str, sequence of str or None
        Patterns, in a list or separated by commas, of sessions or runs that are held out, or that are left out.

    Raises
    ------
    ValueError
        If no recordings remain to fit or to hold out, or a choice is missing; it lists the choices.
    """
    every = (*files.recordings, *(judging.recordings if judging else ()))
    refused = (*files.refused, *(judging.refused if judging else ()))
    for each in (files, *([judging] if judging else ())):
        each.require_usable()
    joint = _only("joint", joint, sorted({each.joint for each in every}), {joint for _, _, joint in refused})
    own = [each for each in every if each.joint == joint]
    for what, patterns in (("without", without), ("holdout", None if judging else holdout)):
        _require_met(what, patterns, own, [run for run in refused if run[2] == joint])
    if judging:
        _require_apart(files.recordings, judging.recordings)
    signal = _only("signal", signal, [name for name in PREDICTED if any(name in each.signals for each in own)])
    reasons = {id(each): _unused(each, signal, without) for each in own}
    used = [each for each in own if not reasons[id(each)]]
    left_out = tuple(f"{each.name}: {reasons[id(each)]}" for each in own if reasons[id(each)])
    left_out += tuple(line for each in (files, judging) if each for line in _refused(each, joint))
    apart = {id(each) for each in judging.recordings} if judging else {id(e) for e in used if _matches(e, holdout)}
    fitted, heldout = (tuple(e for e in used if (id(e) in apart) == held) for held in (False, True))
    if not fitted or not heldout:
        sessions = ", ".join(sorted({each.session for each in used})) or "none"
        unused = f"; not used: {'; '.join(left_out)}" if left_out else ""
        raise ValueError(
            f"holdout={holdout} leaves {len(fitted)} recordings of {joint} to fit and {len(heldout)} held out: give a "
            f"pattern of some of the sessions {sessions}, or of their runs, or a folder of held-out recordings{unused}"
        )
    floor, how = _floor(files, joint, signal)
    return Case(Table(fitted, signal), Table(heldout, signal), floor, how, left_out)


def _floor(files: JointRecordings, joint: str, signal: str) -> tuple[float | None, str]:
    """Noise of a signal from recordings at rest, else from recordings in which other joints moved; and its origin."""
    resting, standing = (
        tuple(each for each in recordings if each.joint == joint and signal in each.signals)
        for recordings in (files.at_rest, files.standing)
    )
    if resting:
        return noise_floor(Table(resting, signal)), "of recordings at rest"
    floor = standing_noise(Table(standing, signal)) if standing else None
    return floor, f"above {SLOW:g} Hz, of the joint standing while another one moved" if floor is not None else ""


def _require_met(
    what: str, patterns: Patterns, recordings: Sequence[JointRecording], refused: Sequence[tuple[str, str, str]]
) -> None:
    """Raise a ValueError for a pattern without a match: recordings to hold out would be fitted unnoticed."""
    for pattern in _patterns(patterns):
        if not any(_matches(each, pattern) for each in recordings):
            sessions = ", ".join(sorted({each.session for each in recordings}))
            lost = [run for session, run, _ in refused if fnmatchcase(session, pattern) or fnmatchcase(run, pattern)]
            why = f"matches only refused recordings ({', '.join(lost)})" if lost else "meets no session and no run"
            raise ValueError(f"{pattern!r} of {what}= {why}: the usable sessions are {sessions}")


def _require_apart(fitted: Sequence[JointRecording], judging: Sequence[JointRecording]) -> None:
    """Raise a ValueError if a recording is in both folders: it would be fitted and held out."""
    known = {each.signals["q"].tobytes(): each.name for each in fitted}
    for each in judging:
        if each.signals["q"].tobytes() in known:
            raise ValueError(
                f"run {each.name} of the holdout folder is also in the recordings to fit, as "
                f"{known[each.signals['q'].tobytes()]}: keep held-out files in a folder outside of them"
            )


def _unused(recording: JointRecording, signal: str, without: Patterns) -> str:
    """Reason why a recording is not used; empty if it is used."""
    if _matches(recording, without):
        return "left out by without="
    if signal not in recording.signals:
        return f"has no {signal}"
    moved = float(np.ptp(recording.signals["q"]))
    return f"moved {moved:.2g} rad, less than {LEAST_WAY} rad" if moved < LEAST_WAY else ""


def _refused(files: JointRecordings, joint: str) -> Iterator[str]:
    """Refused recordings of a joint with their findings."""
    for _, run, own in files.refused:
        if own == joint:
            labels = run, f"{run} {joint}"
            kinds = dict.fromkeys(d.kind for d in files.defects if d.severity == "refuse" and d.recording in labels)
            yield f"{run}: refused for {', '.join(kinds)}"


def _only(what: str, wanted: str | None, available: Sequence[str], refused: set[str] | None = None) -> str:
    """The wanted choice, or the only one."""
    if wanted in available:
        return str(wanted)
    if wanted is None and len(available) == 1:
        return available[0]
    choices = ", ".join(f"{name} ({SIGNALS[name].meaning})" if name in SIGNALS else name for name in available)
    if not choices:
        raise ValueError(f"no recording has a signal to explain: map {' or '.join(PREDICTED)} in the source")
    if wanted is None:
        raise ValueError(f"the recordings have several: choose {what}= from {choices}")
    why = "has refused recordings only" if refused and wanted in refused else "is not in the recordings"
    raise ValueError(f"{what}={wanted} {why}: choose {what}= from {choices}")


def _patterns(patterns: Patterns) -> list[str]:
    every = patterns.split(",") if isinstance(patterns, str) else map(str, patterns or ())
    return [each.strip() for each in every if each.strip()]


def _matches(recording: JointRecording, patterns: Patterns) -> bool:
    """Whether the session or the run of a recording matches one of the patterns."""
    names = recording.session, recording.name
    return any(fnmatchcase(name, pattern) for pattern in _patterns(patterns) for name in names)
