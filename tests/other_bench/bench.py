"""A run of the bench: a healthy session, then another one of the same unit with something hidden in it."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from jaxtyping import Float

from other_bench.acquisition import Errors, acquired, typical
from other_bench.effects import Effect
from other_bench.gauges import maps_of
from other_bench.motion import moved
from other_bench.schedule import Run, session
from other_bench.specimen import draw

COLUMNS = {
    "t_s": "%.6f", "phi_in_rad": "%.6f", "n_in_rpm": "%.2f", "T_in_nm": "%.5f", "T_out_nm": "%.4f",
    **{f"s{gauge}_mv_v": "%.6f" for gauge in range(5)},
}  # fmt: skip
MANIFEST = "recording,file,gear,session,n_in_rpm,T_out_nm,repeat,temperature_c,elapsed_s"


def record(out: Path, seed: int, effect: Effect, unit: str) -> None:
    """Write out/commissioning, out/recordings, and out/truth.json beside them.

    Parameters
    ----------
    out : Path
        A folder without the three.
    seed : int
        Of both sessions.
    effect : Effect
        In the second of them.
    unit : str
        Name of the specimen.
    """
    folders = [out / "commissioning", out / "recordings"]
    rng = np.random.default_rng([seed, 2024])
    healthy = draw(unit)
    units = [healthy, effect.on(healthy)]
    plans = [session(each, name, rng) for each, name in zip(units, ("commissioning", "autumn"), strict=True)]
    motions = moved([run for plan in plans for run in plan])
    level = typical(maps_of(healthy))
    sessions = {}
    for folder, each, plan in zip(folders, units, plans, strict=True):
        errors, maps = Errors.drawn(rng), maps_of(each)
        own, motions = motions[: len(plan)], motions[len(plan) :]
        rows = [acquired(run, motion, maps, errors, level, rng) for run, motion in zip(plan, own, strict=True)]
        write(folder, f"unit {unit}", plan, rows)
        really = [{name: value for name, value in vars(run).items() if name != "unit"} for run in plan]
        sessions[folder.name] = {"errors": errors._asdict(), "recordings": really}
    truth = {
        "seed": seed, "unit": unit, "effect": effect.truth, "healthy": asdict(healthy), "typical_mv_v": level,
        "sessions": sessions,
    }  # fmt: skip
    (out / "truth.json").write_text(json.dumps(truth, indent=1, default=_plain) + "\n")


def write(folder: Path, gear: str, runs: Sequence[Run], rows: Sequence[Float[np.ndarray, "_ column"]]) -> None:
    """Recordings as a folder of CSV files with a manifest."""
    folder.mkdir(parents=True)
    lines = [MANIFEST]
    for number, (run, values) in enumerate(zip(runs, rows, strict=True), 1):
        name = f"run{number:02d}.csv"
        np.savetxt(
            folder / name, values, fmt=list(COLUMNS.values()), delimiter=",", header=",".join(COLUMNS), comments=""
        )
        said = f"{run.session},{run.n:g},{run.T:g},{run.repeat},{run.temperature:.2f},{run.elapsed:.1f}"
        lines.append(f"run {number},{name},{gear},{said}")
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n")


def _plain(value: object) -> object:
    """What JSON has no form for: an array as a list, a complex number as its two parts."""
    if isinstance(value, complex):
        return [value.real, value.imag]
    return np.asarray(value).tolist()
