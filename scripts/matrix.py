"""The same numbers on the oldest and the newest NumPy: ``python scripts/matrix.py`` (docs/reliability.md).

Each has an environment in ``build/matrix`` that lies over the one of the project: the libraries that calculate are its
own, all others are the project's. In it the small data sets are made and the paper's tables run on them.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import venv
from importlib.metadata import version
from pathlib import Path

import numpy as np
from same_numbers import beyond, compared, table
from tqdm import tqdm

from swgsim.common.files import write_json

ROOT = Path(__file__).parents[1]
LIBRARIES = ("numpy", "scipy", "pandas")  # not scikit-learn: its versions deal grouped folds differently
CONDITIONS = ("clean", "disturbed")
TABLES = ("table7", "table8", "table9", "table10")
FEATURES = ("selection_all", "harmonics")


def main() -> None:
    """Print a table, and write ``matrix.json``; the exit status is 1 if numbers differ beyond their tolerance."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--tables", nargs="+", choices=TABLES, default=TABLES, help="the experiments that are run")
    asked.add_argument("--folder", type=Path, default=ROOT / "build" / "matrix", help="where the environments are kept")
    asked.add_argument("--report", type=Path, default=ROOT / "report")
    asked.add_argument("--gather", action="store_true", help=argparse.SUPPRESS)  # in an environment, after its work
    chosen = asked.parse_args()
    if chosen.gather:
        np.savez("numbers.npz", **gathered(Path.cwd()))
        write_json(Path("versions.json"), {library: version(library) for library in LIBRARIES})
        return
    works = {name: worked(name, chosen.folder / name, chosen.tables) for name in ("oldest", "newest")}
    versions = {name: json.loads((work / "versions.json").read_text()) for name, work in works.items()}
    rows = compared(*(np.load(work / "numbers.npz") for work in works.values()))
    write_json(chosen.report / "matrix.json", {"versions": versions, "rows": rows})
    for name, each in versions.items():
        print(f"{name}: {', '.join(f'{library} {number}' for library, number in each.items())}")
    print(table(rows))
    if different := beyond(rows):
        sys.exit("the oldest and the newest libraries differ: " + "; ".join(different))


def worked(name: str, folder: Path, tables: list[str]) -> Path:
    """The folder in which the commands have been run with an environment's libraries."""
    python = environment(name, folder)
    work = folder / "work"
    shutil.rmtree(work, ignore_errors=True)  # what is there would be taken for done
    work.mkdir()
    steps = [["generate.py", "grid=small", f"condition={condition}"] for condition in CONDITIONS]
    steps += [["train.py", "grid=small", f"experiment={table}"] for table in tables]
    log = work / "log.txt"
    for script, *words in tqdm([*steps, ["matrix.py", "--gather"]], desc=name, unit=" commands"):
        with log.open("a") as said:
            command = [python, ROOT / "scripts" / script, *words]
            done = subprocess.run(command, cwd=work, stdout=said, stderr=subprocess.STDOUT)
        if done.returncode:
            end = log.read_text()[-2000:]
            sys.exit(f"{script} {' '.join(words)} failed on the {name} libraries; {log} ends:\n{end}")
    return work


def environment(name: str, folder: Path) -> Path:
    """The Python of an environment, which is made anew unless it is whole and pip would change nothing in it."""
    python, ready, asked = folder / "bin" / "python", folder / "ready", "\n".join(requirements(name))
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--upgrade", *requirements(name)]
    if ready.exists() and ready.read_text() == asked:
        report = subprocess.run([*pip, "--quiet", "--dry-run", "--report", "-"], check=True, stdout=subprocess.PIPE)
        if not json.loads(report.stdout)["install"]:
            return python
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder, symlinks=True)
    own = Path(sysconfig.get_path("purelib", "venv", {"base": str(folder)}))
    (own / "project.pth").write_text(f"import site; site.addsitedir({sysconfig.get_path('purelib')!r})\n")
    print(f"{name}: {', '.join(requirements(name))}", flush=True)
    subprocess.run(pip, check=True)
    ready.write_text(asked)
    return python


def requirements(name: str) -> list[str]:
    """Of the libraries that calculate: the lower bounds of ``pyproject.toml``, or what it allows."""
    said = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    allowed = [each for each in said if re.split("[<>=]", each)[0] in LIBRARIES]
    return [re.sub(r">=([^,]+).*", r"==\1", each) for each in allowed] if name == "oldest" else allowed


def gathered(work: Path) -> dict[str, np.ndarray]:
    """Signals, facts, features and metrics of the data sets and runs in a folder."""
    from scale import composed

    from learn.jobs import settings
    from learn.tracking import finished_runs, local_store
    from swgsim.storage import storage

    numbers = {}
    for condition in CONDITIONS:
        recordings = storage.read(work / "data" / f"small-{condition}.h5")
        numbers[f"signals/{condition}/all"] = recordings.signals
        facts = recordings.table.assign(label=recordings.table["label"].cat.codes)
        numbers |= {f"facts/{condition}/{name}": column.to_numpy() for name, column in facts.items()}
        for name in FEATURES:
            inputs = settings.representation(composed("train", f"features={name}")["features"])
            numbers[f"features/{condition}/{name}"] = inputs.learning_set([recordings]).features
    runs = finished_runs(local_store(str(work / "mlruns")), grid="small")
    runs = runs.set_index(["study", "classifier", "features", "protocol"]).select_dtypes("number")
    for (study, *job), metrics in runs.drop(columns="fit_seconds").sort_index(axis=1).iterrows():
        numbers[f"metrics/{study}/{' '.join(job)}"] = metrics.to_numpy()
    return numbers


if __name__ == "__main__":
    main()
