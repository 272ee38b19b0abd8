"""The command ``swg diagnose``: recordings of a gear and of its healthy state in, the diagnosis out as a folder."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from swgsim.common.files import require_writable
from swgsim.identification.report.close_loop import library
from swgsim.identification.report.loop_input import read_input, say
from swgsim.twin.unit_diagnosis import Diagnosis, diagnose


def run(config: Mapping[str, Any]) -> Diagnosis:
    """Write ``diagnosis.json``, ``page.html`` and the folder ``loop`` into the folder ``out``, and print the sentence.

    Steps are printed on standard error while they run.

    Raises
    ------
    ValueError
        If recordings cannot be used, do not belong together, or a choice is unknown; the message says what to do.
    OSError
        If the folder ``out`` cannot be written.
    """
    kinds, out = library(config), Path(config["out"])
    require_writable(out)
    recordings, gear, declared, healthy = read_input(config)
    if healthy is None:
        raise ValueError(
            "no healthy recordings: give commissioning=FOLDER of this gear when it was healthy, or the file of swg "
            "commission; without them use swg close-loop"
        )
    found = diagnose(
        recordings, healthy, gear, declared=declared, prior=config["prior"],
        false_alarms=config["false_alarms"], costs=config["costs"], effects=kinds, seed=config["seed"], progress=say,
    )  # fmt: skip
    found.save(out)
    print(f"{found.sentence}\n{out / 'page.html'}")
    return found
