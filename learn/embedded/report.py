"""The study of exported methods: runs missing methods, then writes ``report/embedded.json``, ``.md`` and ``.png``.

The figure needs the tools of the microcontrollers.
"""

import hashlib
import json
import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits
from tqdm import tqdm

from learn.embedded.figure import drawn
from learn.embedded.machines import HOST, missing, require_tools
from learn.embedded.outcome import MICROCONTROLLERS, outcome
from learn.embedded.table import errors_of, variants_of
from learn.embedded.text import markdown
from learn.embedded.trade import Part, recommend
from learn.jobs import identity, settings
from swgsim.common.compute import Engine
from swgsim.common.files import replacing, write_json, write_text
from swgsim.common.seeds import generator
from swgsim.common.style import png
from swgsim.storage import storage

log = logging.getLogger(__name__)

PRESENTATION = (
    "report.py",
    "table.py",
    "text.py",
    "figure.py",
    "trade.py",
    "export_job.py",
    "gateway.py",
)  # no result depends on them


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Do the study of a resolved ``conf/embedded.yaml``; a method that was finished before is not repeated.

    Returns
    -------
    dict
        Content of embedded.json.

    Raises
    ------
    ValueError
        If a data set does not exist, with the command to make it, or there is no method or no C compiler.
    """
    if not config["methods"]:
        raise ValueError("methods is empty, so nothing would be compared: leave at least one of conf/embedded.yaml")
    require_tools(HOST)
    for machine in MICROCONTROLLERS:
        packages = ", ".join(missing(machine))
        if packages:
            log.warning("%s is left out, because %s is missing: run scripts/install_arm.sh", machine.name, packages)
    results = [entry for method in _outcomes(config) for entry in method]
    variants, errors = variants_of(results), errors_of(results)
    part = Part.of(config["part"])
    measured = "flash" in variants
    advice = recommend(variants, errors, part, generator("embedded", 0)) if measured else None
    listed = variants.reset_index().astype(object)
    found = {
        "part": dict(config["part"]),
        "variants": listed.where(listed.notna(), None).to_dict("records"),
        "recommendation": advice and advice._asdict(),
    }
    folder = Path(config["report"])
    text = markdown(variants, part, advice)
    write_json(folder / "embedded.json", found)
    write_text(folder / "embedded.md", text)
    if measured:
        with replacing(folder / "embedded.png") as aside:
            aside.write_bytes(png(drawn(variants, part)))
    print(text)
    return found


def _outcomes(config: Mapping[str, Any]) -> list[list[dict[str, Any]]]:
    """Of every method, from its file where it was finished before."""
    files = {name: Path(config["embedded"]) / f"{key}.json" for name, key in _keys(config).items()}
    waiting = [name for name, path in files.items() if not path.exists()]
    with tqdm(total=len(files), initial=len(files) - len(waiting), desc="methods") as bar:
        tasks = [(config, name, files[name]) for name in waiting]
        for _ in Engine.of(config).results(_finished, tasks, len(tasks)):
            bar.update()
    return [json.loads(path.read_text()) for path in files.values()]


def _finished(config: Mapping[str, Any], name: str, path: Path) -> None:
    with threadpool_limits(1):
        write_json(path, outcome(config, name))


def _keys(config: Mapping[str, Any]) -> dict[str, str]:
    """Key of each method's result; it changes with all that the result depends on."""
    digest = hashlib.sha256(identity.code_version().encode())
    sources = (path for path in Path(__file__).parent.rglob("*") if path.suffix in (".py", ".c", ".h", ".ld"))
    for source in sorted(path for path in sources if path.name not in PRESENTATION):
        digest.update(source.read_bytes())
    for name in ("unseen", "disturbed"):
        grid, _, condition = config[name].rpartition("-")
        digest.update(storage.digest(settings.data_set({**config, "grid": grid, "condition": condition})).encode())
    common = [config[key] for key in ("inputs", "classifiers", "judged", "proof", "counted")]
    common.append([machine.name for machine in MICROCONTROLLERS if not missing(machine)])
    return {
        name: hashlib.sha256(json.dumps([digest.hexdigest(), common, method], sort_keys=True).encode()).hexdigest()[:16]
        for name, method in config["methods"].items()
    }
