"""The job of scripts/joints.py: every case whose files are there, and one report of all of them."""

import hashlib
import json
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from tqdm import tqdm

from swgsim.common.compute import Engine
from swgsim.common.files import replacing, write_json, write_text
from swgsim.common.version import code_version
from swgsim.joint import close_joint_loop as job
from swgsim.joint.cases_page import page, tables

# Pictures of the documentation.
LADDER, REASONS = ("ladder",), ("waves", "unexplained", "friction")
# Choices of close_loop.py that a case need not make.
OPEN: Mapping[str, Any] = {"joint": None, "signal": None, "without": None, "searched": None, "library": []}


def run(config: Mapping[str, Any]) -> None:
    """Answer the cases, and write ``joints.json`` and ``joints.html``.

    Raises
    ------
    ValueError
        If no case meets the pattern; it lists them.
    """
    chosen = {name: case for name, case in config["cases"].items() if fnmatchcase(name, config["only"])}
    if not chosen:
        raise ValueError(f"only={config['only']} is no case: choose from {', '.join(config['cases'])}")
    folders = {name: Path(config["folder"]) / case["recordings"] for name, case in chosen.items()}
    lost = "{} is not there: docs/joint_recordings.md says where to get it"
    missing = {name: lost.format(folder) for name, folder in folders.items() if not folder.is_dir()}
    for name, reason in missing.items():
        print(f"{name}: {reason}")
    there = {name: case for name, case in chosen.items() if name not in missing}
    tasks = (
        ({**OPEN, **case} | {"recordings": str(folders[name]), "out": str(Path(config["out"]) / _plain(name))},)
        for name, case in there.items()
    )
    answers = Engine.of(config).results(answered, tasks, len(there))
    said = dict(zip(there, tqdm(answers, "joints", total=len(there), unit=" cases"), strict=True))
    for name, reason in [(name, each) for name, each in said.items() if isinstance(each, str)]:
        missing[name] = reason
        del said[name]
        print(f"{name}: {reason}")
    write_json(Path(config["report"]) / "joints.json", ladders(said, missing))
    own = {name: Path(config["out"]) / _plain(name) for name in said}
    write_text(Path(config["report"]) / "joints.html", page(said, missing, own))
    if config["docs"] is not None:
        _document(Path(config["docs"]), said, own)
    for name, each in said.items():
        before, after = each["error"]["before"], each["error"]["after"]
        print(f"{name}: {before['heldout']:.3g} -> {after['heldout']:.3g} {each['unit']} on recordings not seen")


def _document(folder: Path, said: Mapping[str, Mapping[str, Any]], own: Mapping[str, Path]) -> None:
    """Write the ladders as Markdown, with pictures beside them: the ladder of every case, and of the first case of a
    signal also those that show why.
    """
    write_text(folder / "ladders.md", tables(said))
    shown: set[tuple[str, ...]] = set()
    for name, answer in own.items():
        signal = tuple(said[name][what] for what in ("robot", "joint", "signal"))
        for picture in LADDER if signal in shown else (*LADDER, *REASONS):
            if (answer / f"{picture}.png").is_file():
                with replacing(folder / f"{answer.name}_{picture}.png") as aside:
                    aside.write_bytes((answer / f"{picture}.png").read_bytes())
        shown.add(signal)


def answered(case: Mapping[str, Any]) -> dict[str, Any] | str:
    """The report of a case, computed unless it was, by the same code of the same files; or why there is none."""
    folder, key = Path(case["out"]), _key(case)
    kept = folder / "key.json"
    if kept.is_file() and json.loads(kept.read_text(encoding="utf-8")) == key:
        return dict(json.loads((folder / "report.json").read_text(encoding="utf-8")))
    try:
        said = job.run(case, lambda _: None).report
    except ValueError as error:
        return str(error)
    write_json(kept, key)
    return dict(said)


def ladders(said: Mapping[str, Mapping[str, Any]], missing: Mapping[str, str]) -> dict[str, Any]:
    """``joints.json``: the ladder of every case, and the cases that could not be answered."""
    return {
        "cases": {
            name: {
                "sentence": each["sentence"], "verdict": each["verdict"], "rungs": each["rungs"],
                "before": each["error"]["before"], "after": each["error"]["after"], "noise_floor": each["noise_floor"],
                "noise_floor_how": each["noise_floor_how"],
                "unit": each["unit"], "split": each["split"], "unknown": each["unknown"], "days": each["days"],
            }
            for name, each in said.items()
        },
        "missing": dict(missing),
    }  # fmt: skip


def _key(case: Mapping[str, Any]) -> str:
    """What an answer depends on: the choices, the source, the files and the code."""
    made = hashlib.sha256(
        json.dumps(dict(case), sort_keys=True).encode() + code_version("joint", "identification").encode()
    )
    for file in (
        job.source_path(case["source"]),
        *sorted(p for p in Path(case["recordings"]).rglob("*") if p.is_file()),
    ):
        made.update(file.name.encode() + file.read_bytes())
    return made.hexdigest()


def _plain(name: str) -> str:
    """A name for a folder."""
    return "_".join("".join(c if c.isalnum() else " " for c in name).split())
