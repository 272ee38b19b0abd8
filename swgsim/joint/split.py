"""Which recordings are fitted, which judge, and which are neither."""

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from swgsim.joint.intake.read import JointFiles
from swgsim.joint.judged import noise_floor, standing_noise
from swgsim.joint.recording import PREDICTED, SIGNALS, JointRecording
from swgsim.joint.regression import Table
from swgsim.joint.slow import SLOW

# A joint that moved less than a revolution of its motor, or this [rad] if the ratio is unknown, did not turn its gear.
LEAST_WAY = 0.05


@dataclass(frozen=True, eq=False)
class Case:
    """A question to recordings of one joint.

    Attributes
    ----------
    table, heldout : Table
        Recordings to fit, and to judge.
    floor : float or None
        Noise of the signal at rest.
    floor_how : str
        Of which rest, in words; empty if none is known.
    left_out : tuple of str
        Names of recordings in neither, with the reason.
    """

    table: Table
    heldout: Table
    floor: float | None
    floor_how: str
    left_out: tuple[str, ...]


def chosen(
    files: JointFiles, judging: JointFiles | None, joint: str | None, signal: str | None, holdout: str | None,
    without: str | None,
) -> Case:  # fmt: skip
    """The recordings of a question.

    Parameters
    ----------
    files : JointFiles
    judging : JointFiles or None
        Files of a folder of their own that judge; None if ``holdout`` says which ones do.
    joint, signal : str or None
        Needed if there are several.
    holdout, without : str or None
        Patterns, separated by commas, of sessions or runs: those that judge, and those to leave out.

    Raises
    ------
    ValueError
        If there is nothing to fit or nothing to judge, or a choice is open; it lists the choices.
    """
    every = (*files.recordings, *(judging.recordings if judging else ()))
    joint = _only("joint", joint, sorted({each.joint for each in every}))
    own = [each for each in every if each.joint == joint]
    for what, patterns in (("without", without), ("holdout", None if judging else holdout)):
        _require_met(what, patterns, own)
    if judging:
        _require_apart(files.recordings, judging.recordings)
    signal = _only("signal", signal, [name for name in PREDICTED if any(name in each.signals for each in own)])
    reasons = {id(each): _unused(each, signal, without) for each in own}
    used = [each for each in own if not reasons[id(each)]]
    apart = {id(each) for each in judging.recordings} if judging else {id(e) for e in used if _matches(e, holdout)}
    fitted, heldout = (tuple(e for e in used if (id(e) in apart) == judges) for judges in (False, True))
    if not fitted or not heldout:
        sessions = ", ".join(sorted({each.session for each in used})) or "none"
        raise ValueError(
            f"holdout={holdout} leaves {len(fitted)} recordings of {joint} to fit and {len(heldout)} to judge: give a "
            f"pattern of some of the sessions {sessions}, or of their runs, or a folder of recordings that judge"
        )
    floor, how = _floor(files, joint, signal)
    left_out = tuple(f"{each.name}: {reasons[id(each)]}" for each in own if reasons[id(each)])
    return Case(Table(fitted, signal), Table(heldout, signal), floor, how, left_out)


def _floor(files: JointFiles, joint: str, signal: str) -> tuple[float | None, str]:
    """Noise of a signal, of recordings at rest or else of those in which other joints moved; and which it is."""
    resting, standing = (
        tuple(each for each in recordings if each.joint == joint and signal in each.signals)
        for recordings in (files.at_rest, files.standing)
    )
    if resting:
        return noise_floor(Table(resting, signal)), "of recordings at rest"
    floor = standing_noise(Table(standing, signal)) if standing else None
    return floor, f"above {SLOW:g} Hz, of the joint standing while another one moved" if floor is not None else ""


def _require_met(what: str, patterns: str | None, recordings: Sequence[JointRecording]) -> None:
    """Raise a ValueError for a pattern that meets nothing: what it was to keep apart would be fitted unnoticed."""
    for pattern in _patterns(patterns):
        if not any(_matches(each, pattern) for each in recordings):
            sessions = ", ".join(sorted({each.session for each in recordings}))
            raise ValueError(f"{pattern!r} of {what}= meets no session and no run: the sessions are {sessions}")


def _require_apart(fitted: Sequence[JointRecording], judging: Sequence[JointRecording]) -> None:
    """Raise a ValueError if a recording is in both folders: it would judge what was fitted to it."""
    there = {each.signals["q"].tobytes(): each.name for each in fitted}
    for each in judging:
        if each.signals["q"].tobytes() in there:
            raise ValueError(
                f"run {each.name} of the holdout folder is also in the recordings to fit, as "
                f"{there[each.signals['q'].tobytes()]}: keep the files that judge in a folder outside of them"
            )


def _unused(recording: JointRecording, signal: str, without: str | None) -> str:
    """Why a recording is neither fitted nor judges; empty if it is used."""
    if _matches(recording, without):
        return "left out as asked"
    if signal not in recording.signals:
        return f"has no {signal}"
    way = 2 * np.pi / recording.gear_ratio if recording.gear_ratio else LEAST_WAY
    moved = float(np.ptp(recording.signals["q"]))
    return f"moved {moved:.2g} rad, less than a revolution of the motor" if moved < way else ""


def _only(what: str, wanted: str | None, there: Sequence[str]) -> str:
    """The one that is wanted, or the only one there is."""
    if wanted in there:
        return str(wanted)
    if wanted is None and len(there) == 1:
        return there[0]
    listed = ", ".join(f"{name} ({SIGNALS[name].says})" if name in SIGNALS else name for name in there) or "none"
    raise ValueError(f"{what}={wanted} is none of the recordings': choose {what}= from {listed}")


def _patterns(patterns: str | None) -> list[str]:
    return [each.strip() for each in (patterns or "").split(",") if each.strip()]


def _matches(recording: JointRecording, patterns: str | None) -> bool:
    """Whether the session or the run of a recording meets one of the patterns."""
    names = recording.session, recording.name
    return any(fnmatchcase(name, pattern) for pattern in _patterns(patterns) for name in names)
