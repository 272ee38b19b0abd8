"""The command ``swg close-loop source=...``: configuration in, the folder of an answer out."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from swgsim.common.files import require_writable
from swgsim.common.outcome import Outcome
from swgsim.joint.identify import effects_of, identify_joint, recordings_of, source_path
from swgsim.joint.intake.read import JointRecordings
from swgsim.tables.file_defect import read_for


def run(config: Mapping[str, Any], report_line: Callable[[str], None] = print, *, bar: bool = True) -> Outcome:
    """Write ``report.json``, ``effects.yaml`` and ``page.html`` into the folder ``out``, and print the answer.

    Raises
    ------
    ValueError
        If recordings cannot be used, or a choice is unknown or missing; it gives the remedy.
    OSError
        If the folder ``out`` cannot be written.
    """
    if config["recordings"] is None:
        raise ValueError("no recordings: give recordings=FOLDER, the files that the source describes")
    effects_of(config["searched"], config["library"])
    source_path(config["source"])
    require_writable(Path(config["out"]))
    report_line(f"reading {config['recordings']}")
    files = _read("recordings", config)
    by_folder = isinstance(config["holdout"], str) and Path(config["holdout"]).is_dir()
    judging = _read("holdout", config) if by_folder else None
    for each in (files, judging):
        if each is not None and (said := each.findings(config["joint"])):
            report_line(said)
    answer = identify_joint(
        files, config["joint"], config["signal"], judging or config["holdout"], config["without"],
        searched=config["searched"], library=config["library"], progress=report_line, bar=bar,
    )  # fmt: skip
    report_line("drawing the page")
    answer.save(config["out"])
    for caution in answer.report["cautions"]:
        report_line(f"caution: {caution}")
    report_line(repr(answer))
    return Outcome(answer.report, {name: drawn for name, (drawn, _) in answer.pictures.items()}, answer.digest)


def _read(what: str, config: Mapping[str, Any]) -> JointRecordings:
    with read_for(what, config[what]):
        return recordings_of(config["source"], config[what])
