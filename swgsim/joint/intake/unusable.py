"""Numbers of a joint that nothing can be computed with."""

from collections.abc import Iterator

import numpy as np

from swgsim.joint.intake.run import Run
from swgsim.joint.intake.thresholds import FEWEST_SAMPLES
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.files.assembly import no_numbers, standing
from swgsim.recordings.files.limits import LARGEST_NUMBER


def unusable(run: Run) -> Iterator[Defect]:
    """Numbers that are not finite, a time that does not increase, too few samples: such a run is left out."""
    if len(run) < FEWEST_SAMPLES:
        found, expected = f"{len(run)} samples after the start", f"at least {FEWEST_SAMPLES}"
        yield Defect("too_short", "refuse", run.label, "", found, expected, "record longer, or cut less of the start")
    columns = {"t": run.time, **run.signals} if run.time is not None else dict(run.signals)
    columns |= {f"posture {number}": values for number, values in enumerate(run.posture, 1)}
    for name, values in columns.items():
        bad = no_numbers(np.asarray(values))
        if len(bad):
            yield Defect(
                "not_finite", "refuse", run.label, name,
                f"{np.asarray(values)[bad[0]]} and {len(bad) - 1} more of {len(run)} samples",
                f"finite numbers within {LARGEST_NUMBER:g}", "record again, or leave the signal out of the source",
                int(bad[0]) + run.first_row,
            )  # fmt: skip
    back = standing(run.time) if run.time is not None else np.empty(0, int)
    if run.time is not None and len(back):
        yield Defect(
            "clock_backwards", "refuse", run.label, "t",
            f"{run.time[back[0]]} after {run.time[back[0] - 1]}", "later times",
            "sample by a clock that only goes on, or write the time with more digits", int(back[0]) + run.first_row,
        )  # fmt: skip
