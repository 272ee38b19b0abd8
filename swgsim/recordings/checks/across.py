"""Missing and duplicate items of a set of recordings."""

from collections import Counter
from collections.abc import Iterator, Sequence

from swgsim.gear.conditions import REFERENCE_TEMPERATURE
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.thresholds import WHOLE_TURNS
from swgsim.recordings.recording import Recording


def set_defects(recordings: Sequence[Recording]) -> Iterator[Defect]:
    """Defects of the recordings as a set."""
    yield from _copies(recordings)
    yield from _short(recordings)
    yield from _repeats(recordings)
    if recordings and all(each.conditions.temperature == REFERENCE_TEMPERATURE for each in recordings):
        yield Defect(
            "no_temperature", "warn", recordings[0].name, "",
            f"{REFERENCE_TEMPERATURE:g} degrees for all recordings, the default of a missing temperature",
            "a measured temperature", "measure it: friction depends on it, and effects of warmth look like faults",
        )  # fmt: skip


def session_defects(recordings: Sequence[Recording], healthy: Sequence[Recording]) -> Iterator[Defect]:
    """A warning for each session that is in the commissioning too."""
    before = {each.session: each.name for each in healthy}
    for session, first in {each.session: each.name for each in reversed(recordings)}.items():
        if session in before:
            yield Defect(
                "session_of_commissioning", "warn", first, "",
                f"the session {session!r}, which recording {before[session]} of the commissioning has too",
                "another session, or the bench as it was: nothing dismounted and no bridge balanced in between",
                "give the later recordings a session of their own, in the manifest or in 'facts' of a map",
            )  # fmt: skip


def _copies(recordings: Sequence[Recording]) -> Iterator[Defect]:
    """The same numbers under two names would count as repeats without noise."""
    first: dict[str, str] = {}
    for each in recordings:
        name = first.setdefault(each.numbers, each.name)
        if name != each.name:
            yield Defect(
                "same_twice", "refuse", each.name, "", f"the same numbers as recording {name}",
                "different recordings", "leave one out: a copy is no repeat",
            )  # fmt: skip


def _short(recordings: Sequence[Recording]) -> Iterator[Defect]:
    for each in recordings:
        turns = len(each.time) / each.rate * each.point.n_in_rpm / 60
        if turns < WHOLE_TURNS - 0.01:
            yield Defect(
                "short", "warn", each.name, "", f"{turns:.2f} revolutions", f"at least {WHOLE_TURNS}",
                "record longer: fractional orders such as those of the cage cannot be separated",
            )  # fmt: skip


def _repeats(recordings: Sequence[Recording]) -> Iterator[Defect]:
    """Missing repeats of the same session and operating point, and duplicate numbers of repeats."""
    settings = Counter((each.gear, each.session, each.point) for each in recordings)
    if settings and max(settings.values()) == 1:
        yield Defect(
            "no_repeats", "warn", recordings[0].name, "", "one recording of each operating point in a session",
            "two or more", "record each at least twice: the noise floor comes from repeats",
        )  # fmt: skip
    seen: dict[tuple, str] = {}
    for each in recordings:
        name = seen.setdefault((each.gear, each.session, each.point, each.repeat), each.name)
        if name != each.name:
            yield Defect(
                "repeat_twice", "warn", each.name, "", f"repeat {each.repeat} as recording {name}",
                "a number for each repeat", "number the repeats of a session and operating point",
            )  # fmt: skip
