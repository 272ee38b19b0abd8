"""The command ``swg joints``: every case whose files are available, and one report of all of them."""

import hashlib
import json
import sys
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from tqdm import tqdm

from swgsim.common.compute import Engine
from swgsim.common.files import replacing, write_json, write_text
from swgsim.common.version import code_version
from swgsim.joint import close_joint_loop
from swgsim.joint.identify import source_path
from swgsim.joint.pages import ladders_as_markdown, page_of_cases

# Pictures for the documentation: of every case, and of the first case of each signal.
LADDER, REASONS = ("ladder",), ("waves", "unexplained", "friction")
# Choices of the command close-loop that a case may leave out.
OPTIONAL: Mapping[str, Any] = {"joint": None, "signal": None, "without": None, "searched": None, "library": []}
# Fields of a report in joints.json.
FIELDS = (
    "sentence",
    "verdict",
    "textbook_explains",
    "rungs",
    "noise_floor",
    "noise_floor_how",
    "unit",
    "split",
    "unknown",
    "days",
    "speeds",
)


def run(config: Mapping[str, Any]) -> None:
    """Answer the cases, and write ``joints.json`` and ``joints.html``.

    Raises
    ------
    ValueError
        If no case matches the pattern, with a list of all; or if no case has an answer, with the reasons.
    """
    patterns = [config["only"]] if isinstance(config["only"], str) else config["only"]
    chosen = {name: case for name, case in config["cases"].items() if any(fnmatchcase(name, each) for each in patterns)}
    if not chosen:
        raise ValueError(f"only={config['only']} matches no case: choose from {', '.join(config['cases'])}")
    folders = {name: Path(config["folder"]) / case["recordings"] for name, case in chosen.items()}
    missing = {name: f"{folder} does not exist" for name, folder in folders.items() if not folder.is_dir()}
    for name, reason in missing.items():
        print(f"{name}: {reason}")
    if len(missing) == len(chosen):
        wanted = ", ".join(sorted({each["recordings"] for each in chosen.values()}))
        raise ValueError(
            f"no recordings in {config['folder']}: it needs the folders {wanted}. They are not part of this project: "
            "docs/joint_recordings.md says where to get them; then give folder=FOLDER"
        )
    out = {name: Path(config["out"]) / _folder_name(name) for name in chosen if name not in missing}
    tasks = (
        (name, {**OPTIONAL, **chosen[name]} | {"recordings": str(folders[name]), "out": str(folder)})
        for name, folder in out.items()
    )
    results = Engine.of(config).results(answered, tasks, len(out))
    answers = dict(zip(out, tqdm(results, "joints", total=len(out), unit=" cases"), strict=True))
    reports = {name: each for name, each in answers.items() if not isinstance(each, str)}
    for name, each in answers.items():
        if isinstance(each, str):
            missing[name] = each
            print(f"{name}: {each}")
    if not reports:
        raise ValueError(f"none of {len(chosen)} cases has an answer, see above")
    write_json(Path(config["report"]) / "joints.json", ladders(reports, missing))
    own = {name: out[name] for name in reports}
    write_text(Path(config["report"]) / "joints.html", page_of_cases(reports, missing, own))
    if config["docs"] is not None:
        _document(Path(config["docs"]), reports, own)
    for name, each in reports.items():
        print(f"{name}: {each['sentence']}")


def _document(folder: Path, reports: Mapping[str, Mapping[str, Any]], own: Mapping[str, Path]) -> None:
    """Write the ladders as Markdown with their pictures, and further pictures of the first case of each signal."""
    write_text(folder / "ladders.md", ladders_as_markdown(reports))
    shown: set[tuple[str, ...]] = set()
    for name, answer in own.items():
        signal = tuple(reports[name][what] for what in ("robot", "joint", "signal"))
        for picture in LADDER if signal in shown else (*LADDER, *REASONS):
            if (answer / f"{picture}.png").is_file():
                with replacing(folder / f"{answer.name}_{picture}.png") as aside:
                    aside.write_bytes((answer / f"{picture}.png").read_bytes())
        shown.add(signal)


def answered(name: str, case: Mapping[str, Any]) -> dict[str, Any] | str:
    """The report of a case, or the reason why it has none. An answer of the same code and files is reused."""
    folder, key = Path(case["out"]), _key(case)
    kept = folder / "key.json"
    if kept.is_file() and json.loads(kept.read_text(encoding="utf-8")) == key:
        return dict(json.loads((folder / "report.json").read_text(encoding="utf-8")))

    def show(text: str) -> None:
        # The carriage return overwrites the progress bar of the cases.
        print(f"\r{name}: {text.splitlines()[0]}", file=sys.stderr, flush=True)

    try:
        report = close_joint_loop.run(case, show, bar=False).report
    except ValueError as error:
        return str(error)
    write_json(kept, key)
    return dict(report)


def ladders(reports: Mapping[str, Mapping[str, Any]], missing: Mapping[str, str]) -> dict[str, Any]:
    """``joints.json``: the ladder of every case, and the cases without an answer."""
    cases = {
        name: {field: each[field] for field in FIELDS}
        | {"before": each["error"]["before"], "after": each["error"]["after"]}
        for name, each in reports.items()
    }
    return {"cases": cases, "missing": dict(missing)}


def _key(case: Mapping[str, Any]) -> str:
    """Digest of the choices, the source, the files and the code."""
    digest = hashlib.sha256(json.dumps(dict(case), sort_keys=True).encode() + code_version("joint").encode())
    recordings = sorted(path for path in Path(case["recordings"]).rglob("*") if path.is_file())
    for file in (source_path(case["source"]), *recordings):
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()


def _folder_name(name: str) -> str:
    """A case's name as the name of a folder."""
    return "_".join("".join(c if c.isalnum() else " " for c in name).split())
