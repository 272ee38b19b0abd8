"""The command ``swg commission``: recordings of a healthy gear in, the unit out as a file."""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from swgsim.common.files import require_writable
from swgsim.identification.calls import commission
from swgsim.identification.report.loop_input import say, source_of
from swgsim.jobs import settings
from swgsim.recordings.checks.defect import summary
from swgsim.recordings.read import read_recordings
from swgsim.tables.file_defect import read_for


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Write the unit into the file ``out``. Steps are printed on standard error while they run.

    Returns
    -------
    dict
        path, recordings and seconds.

    Raises
    ------
    ValueError
        If recordings cannot be used, or do not fit the nominal gear at all; the message says what to do.
    OSError
        If the file cannot be written.
    """
    start, out = time.perf_counter(), Path(config["out"])
    source = source_of(config)
    require_writable(out.parent)
    gear, declared = settings.gear(config["gear"]), settings.effects(config["effects"])
    say(f"reading {source}")
    with read_for("recordings", source):
        recordings = read_recordings(source, config["mapping"] or None)
    if recordings.defects:
        say(summary(recordings.defects))
    unit = commission(recordings, gear, declared=declared, progress=say)
    unit.save(out)
    seconds = round(time.perf_counter() - start, 1)
    print(f"{out}: {unit!r}; {seconds:.1f} s")
    return {"path": str(out), "recordings": len(recordings), "seconds": seconds}
