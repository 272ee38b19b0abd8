"""Data sets larger than the memory: ``python scripts/large.py`` (docs/scale.md).

Each data set is generated, turned into inputs and used for training, with at most 2 GiB of memory per process.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from math import ceil
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
LIMIT = 2 * 2**30  # bytes
OF_VARIANT = 36  # recordings: six classes at six operating points
REFERENCES = 120  # healthy recordings of a gear
VARIANTS = 60  # of a gear, at most
SIZES = (1_000, 10_000, 100_000, 500_000)
STAGES = ("generate", "inputs", "training")


def main() -> None:
    """Print a table, and write ``large.json`` and ``large.png``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recordings", type=int, nargs="+", default=SIZES, help="sizes of the data sets")
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "large", help="where the data sets are kept")
    parser.add_argument("--report", type=Path, default=ROOT / "report")
    parser.add_argument("--learn", help=argparse.SUPPRESS)  # option of the child process
    options = parser.parse_args()
    if options.learn:
        print(json.dumps(learnt(Path(options.learn))))
        return
    print("| recordings | GiB | " + " | ".join(f"{s} [ms]" for s in STAGES) + " | most memory [MiB] |")
    print("|--:|--:|--:|--:|--:|--:|")
    rows = []
    for size in options.recordings:
        row = measured(size, options.folder / str(size))
        cells = [f"{row[f'{stage}_ms']:.2f}" for stage in STAGES]
        print(f"| {row['recordings']} | {row['gib']:.2f} | {' | '.join(cells)} | {row['peak_mib']:.0f} |", flush=True)
        rows.append(row)
    from swgsim.common.files import write_json

    write_json(options.report / "large.json", {"limit_mib": LIMIT // 2**20, "rows": rows})
    draw(rows, options.report / "large.png")


def measured(recordings: int, folder: Path) -> dict[str, Any]:
    """Milliseconds per recording of every stage, and the peak memory of a stage in all its processes."""
    gears = max(round(recordings / (OF_VARIANT * VARIANTS + REFERENCES)), 1)
    variants = min(ceil((recordings / gears - REFERENCES) / OF_VARIANT), VARIANTS)
    words = ["grid=sampled", "condition=bench", f"grid.population.count={gears}", f"grid.variants={variants}"]
    if folder.exists():
        for left in folder.glob("sampled-bench.*"):
            left.unlink()  # so that it is made and timed again
    started(["-m", "swgsim", "generate", *words, f"data={folder}"])
    path = folder / "sampled-bench.h5"
    summary = json.loads(path.with_suffix(".json").read_text())
    learning = json.loads(started(["scripts/large.py", "--learn", str(path)]).splitlines()[-1])
    count = summary["recordings"]
    seconds = {"generate": summary["seconds"], "inputs": learning["inputs"], "training": learning["training"]}
    return {
        "recordings": count,
        "gib": path.stat().st_size / 2**30,
        **{f"{stage}_ms": 1000 * seconds[stage] / count for stage in STAGES},
        "peak_mib": max(summary["peak_memory_mib"], learning["peak_mib"]),
    }


def started(arguments: list[str]) -> str:
    """Output of a command with a limit of memory in every process."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_DATA, (LIMIT, LIMIT))

    # The memory pool of pyarrow reserves a GiB of addresses, which this limit counts.
    environment = {**os.environ, "ARROW_DEFAULT_MEMORY_POOL": "system"}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True, preexec_fn=limited,
    )  # fmt: skip
    return done.stdout


def learnt(path: Path) -> dict[str, float]:
    """Seconds to make the inputs of a data set and to train a convolutional network on them for one epoch."""
    import torch  # noqa: F401  (before the clock starts)

    from learn.inputs.signals import Signals
    from learn.jobs.train_job import learning_set_of
    from learn.methods.neural import convolutional_network
    from swgsim.dataset.dataset import usage
    from swgsim.storage import storage

    began = time.perf_counter()
    data = learning_set_of(path, storage.digest(path), Signals("residual"))
    prepared = time.perf_counter()
    network = convolutional_network(**data.layout._asdict(), epochs=1, device="cpu")
    network.fit(data.features, data.table["label"].astype(str).to_numpy())
    return {"inputs": prepared - began, "training": time.perf_counter() - prepared, "peak_mib": usage().peak_memory_mib}


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Cost per recording, and memory, over the size of the data set."""
    from matplotlib.figure import Figure

    from swgsim.common.files import replacing

    figure = Figure(figsize=(9, 3.6), layout="constrained")
    cost, memory = figure.subplots(1, 2)
    sizes = [row["recordings"] for row in rows]
    for stage in STAGES:
        cost.plot(sizes, [row[f"{stage}_ms"] for row in rows], "o-", label=stage)
    memory.plot(sizes, [row["peak_mib"] for row in rows], "o-", color="black", label="all processes of a stage")
    memory.axhline(LIMIT / 2**20, ls="--", color="grey", label="limit")
    cost.set(xscale="log", xlabel="recordings", ylabel="ms per recording")
    memory.set(xscale="log", xlabel="recordings", ylabel="memory [MiB]")
    for axes in (cost, memory):
        axes.set_ylim(0)
        axes.legend()
    with replacing(path) as aside:
        figure.savefig(aside, format="png", dpi=130)


if __name__ == "__main__":
    main()
