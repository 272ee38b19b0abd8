"""All checks of the numbers of recordings."""

from collections.abc import Iterator, Sequence

from swgsim.recordings.checks.across import set_defects
from swgsim.recordings.checks.angle import angle_defects
from swgsim.recordings.checks.channel import channel_defects
from swgsim.recordings.checks.clock import clock_defects
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.gauge import gauge_defects
from swgsim.recordings.checks.speed import speed_defects
from swgsim.recordings.checks.steadiness import steadiness_defects
from swgsim.recordings.checks.torque import torque_defects
from swgsim.recordings.checks.wiring import wiring_defects
from swgsim.recordings.files.assembly import no_numbers, standing
from swgsim.recordings.recording import Recording
from swgsim.tables.clock_jump import jump_remedy
from swgsim.tables.file_defect import FIRST_ROW
from swgsim.tables.limits import FEWEST_ROWS, LARGEST_NUMBER

OF_ONE = (
    clock_defects,
    angle_defects,
    speed_defects,
    torque_defects,
    steadiness_defects,
    channel_defects,
    gauge_defects,
)


def inspect(recordings: Sequence[Recording]) -> tuple[Defect, ...]:
    """All defects in the numbers of recordings, in the order of the checks.

    A recording with numbers that are unfit for computation is reported and excluded from the other checks.
    """
    unusable = {recording.name: found for recording in recordings if (found := list(_unusable(recording)))}
    sound = [recording for recording in recordings if recording.name not in unusable]
    defects = [defect for found in unusable.values() for defect in found]
    for recording in sound:
        for detect in OF_ONE:
            defects.extend(detect(recording))
    defects.extend(wiring_defects(sound))
    defects.extend(set_defects(sound))
    return tuple(defects)


def _unusable(recording: Recording) -> Iterator[Defect]:
    """Numbers that are not finite, a time that does not increase, too few samples."""
    name = recording.name
    if len(recording.time) < FEWEST_ROWS:
        found, expected = f"{len(recording.time)} samples", f"at least {FEWEST_ROWS}"
        yield Defect("too_few_samples", "refuse", name, "t", found, expected, "record longer")
    for channel, values in {"t": recording.time, **recording.channels}.items():
        bad = no_numbers(values)
        if len(bad):
            row = int(bad[0]) + FIRST_ROW
            remedy = "record again, or leave the channel out"
            expected = f"a finite number within {LARGEST_NUMBER:g}"
            yield Defect("not_finite", "refuse", name, channel, str(values[bad[0]]), expected, remedy, row)
    back = standing(recording.time)
    if len(back):
        before, after = recording.time[back[0] - 1], recording.time[back[0]]
        row = int(back[0]) + FIRST_ROW
        remedy = jump_remedy(float(before - after))
        yield Defect("clock_backwards", "refuse", name, "t", f"{after} after {before}", "later times", remedy, row)
