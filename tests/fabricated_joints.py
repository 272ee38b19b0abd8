"""Small files of the layout of the two shipped sources, made up by formula: no number of them was measured."""

import gzip
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from swgsim.common.seeds import generator

CONF = Path(__file__).parents[1] / "conf" / "sources"
KINOVA, UR = CONF / "kinova_gen3.yaml", CONF / "ur10e.yaml"
MEASURED = Path(__file__).parents[2] / "shared" / "measured"

KINOVA_RATE = 880.0
START = 500
Table = dict[str, np.ndarray]


def kinova_run(speed: float, seed: object, rows: int = 1500, transient: int = START) -> Table:
    """A joint that starts and then turns at one speed, past the wrap of its angle."""
    rng = generator("fabricated kinova", speed, seed)
    samples = np.arange(START + rows)
    omega = speed * (1 - np.exp(-samples / (transient / 10)))
    q = 6.0 + np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2)]) / KINOVA_RATE
    torque = 0.1 + 0.05 * np.sin(200 * q) + 0.01 * rng.normal(size=len(q))
    return {
        "ctrl_torque_Nm": np.full(len(q), 0.5),
        "position_rad": np.mod(q + 1e-6 * rng.normal(size=len(q)), 2 * np.pi),
        "velocity_rad_s": omega * (1 + 0.02 * rng.normal(size=len(q))),
        "torque_sensor_Nm": torque,
        "current_cmd_A": np.full(len(q), 0.1),
        "current_A": 0.12 + 0.01 * rng.normal(size=len(q)),
        "friction_obs_Nm": np.full(len(q), np.nan),
    }


def kinova_rest(rows: int = 400) -> Table:
    """The joint at rest."""
    rng = generator("fabricated kinova at rest")
    run = kinova_run(0.0, "rest", rows)
    run["position_rad"] = np.full(START + rows, 1.6)
    run["velocity_rad_s"] = 1e-5 * rng.normal(size=START + rows)
    return run


def ur_run(moved: range | tuple[int, ...], seed: object, rows: int = 1200) -> np.ndarray:
    """Columns of a UR10e file, whose joints swing or stand still."""
    rng = generator("fabricated UR", seed)
    time = np.round(np.cumsum(np.where(np.arange(rows) % 3 == 2, 0.012, 0.010)), 4)
    blocks = np.zeros((5, 6, rows))
    for joint in range(1, 7):
        phase = 2 * np.pi * (0.15 + 0.02 * joint) * time + joint
        size = 1.0 if joint in moved else 0.0
        blocks[0, joint - 1] = size * np.sin(phase)
        blocks[1, joint - 1] = size * 2 * np.pi * (0.15 + 0.02 * joint) * np.cos(phase)
        blocks[2, joint - 1] = joint + np.tanh(20 * blocks[1, joint - 1]) + 0.1 * rng.normal(size=rows)
        blocks[3, joint - 1] = blocks[2, joint - 1]
        blocks[4, joint - 1] = 10.0 * joint * np.cos(blocks[0, joint - 1])
    return np.vstack([100 + time, blocks.reshape(30, rows)]).T


def csv_text(header: str, rows: np.ndarray) -> bytes:
    lines = [*([header] if header else []), *(",".join(map(repr, row)) for row in rows.tolist())]
    return ("\n".join(lines) + "\n").encode()


def write_file(path: Path, content: bytes) -> None:
    """Compressed if its name says so."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(content, 1) if path.suffix == ".gz" else content)


def write_kinova(path: Path, run: Table) -> None:
    write_file(path, csv_text(",".join(run), np.column_stack(list(run.values()))))


@cache
def sound_kinova(session: str, speed: float) -> bytes:
    run = kinova_run(speed, session) if speed else kinova_rest()
    return csv_text(",".join(run), np.column_stack(list(run.values())))


@cache
def sound_ur(moved: range | tuple[int, ...], seed: str) -> bytes:
    return csv_text("", ur_run(moved, seed))


def kinova_folder(folder: Path, spoil: Callable[[Table], Table] | None = None) -> Path:
    """Three runs of a session and one of another, of which the first, S1 at 0.5 rad/s, may be spoiled."""
    for session, speed in (("S1_2021-01-01", 0.5), ("S1_2021-01-01", 0.3), ("S1_2021-01-01", 0.7), ("S2_x", 0.5)):
        write_file(folder / f"{session}_v{speed:.2f}.csv.gz", sound_kinova(session, speed))
    if spoil is not None:
        write_kinova(folder / "S1_2021-01-01_v0.50.csv.gz", spoil(kinova_run(0.5, "S1_2021-01-01")))
    write_file(folder / "standstill_noise_2021-01-02.csv", sound_kinova("rest", 0.0))
    (folder / "breakaway_1.csv").write_text("breakaway_torque_Nm,ramp\n1.8,0.05\n")
    return folder


SPOILED = "S1_2021-01-01_v0.50 joint_7"


def ur_folder(folder: Path, spoil: Callable[[np.ndarray], np.ndarray] | None = None) -> Path:
    """Joint 2 alone, and a trajectory of all joints without and with a payload; joint 2 alone may be spoiled."""
    alone = sound_ur((2,), "alone") if spoil is None else csv_text("", spoil(ur_run((2,), "alone")))
    write_file(folder / "jointwise" / "ur-1-joint_2.csv.gz", alone)
    write_file(folder / "multijoint" / "ur-2-8harm.csv", sound_ur(range(1, 7), "all"))
    write_file(folder / "multijoint" / "ur-2-8harmLoad.csv", sound_ur(range(1, 7), "load"))
    return folder


UR_SPOILED = "ur-1-joint_2 joint_2"
