"""Record one case: ``python -m shell_bench OUT --seed S --case K``."""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .cases import case_of
from .drive import LENGTH, RATE, run
from .mesh import PLACES, TEETH, TURN, gauge_map, one_tooth, tooth_signal
from .shell import WAVES

SPEEDS, LOADS, REPEATS = (2000, 3000, 4000), (7, 39), 3
COLUMNS = "t_s,phi_in_rad,n_in_rpm,T_in_nm,T_out_nm,s0_mv_v,s1_mv_v,s2_mv_v,s3_mv_v,s4_mv_v"
DIGITS = "%.4f,%.5f,%.2f,%.5f,%.3f" + 5 * ",%.6f"


@dataclass(frozen=True)
class Day:
    """How a day in the laboratory differs from another: degrees, gains and zeros of the amplifiers, drift (mV/V)."""

    warmth: float
    gains: np.ndarray
    zeros: np.ndarray
    drift: np.ndarray


def new_day(rng):
    """Draw the conditions of a day."""
    gains, zeros, drift = rng.normal(size=(3, 5))
    return Day(rng.normal(), 1 + 3e-4 * gains, 1e-3 * zeros, 5e-4 * drift)


def grid_signals(gear, angle, torque):
    """Signals of the eight grids in mV/V, of shape (grids, samples, recordings)."""
    return np.array([spline.ev(angle % TURN, torque) for spline in gauge_map(gear.mesh, gear.grids)])


def chipped_signals(gear, motion):
    """The same for a circular spline with a gap: the other teeth carry what is missing there."""
    force, single = one_tooth(gear.mesh), tooth_signal(gear.mesh, gear.grids)
    missing, total = np.zeros((PLACES.size, *motion.angle.shape)), np.zeros(motion.angle.shape)
    for tooth in range(gear.chipped):
        place = motion.output + TURN * tooth / TEETH
        lost = force.ev((place - motion.angle) % TURN, motion.torque)
        total += lost
        for n in range(WAVES):
            missing += lost * (single[:, n, None, None] * np.exp(-1j * n * place)).real
    return grid_signals(gear, motion.angle, motion.torque + total * gear.mesh.shell.radius) - missing


def noise(rng, shape):
    """Noise of an amplifier in mV/V: white, and some that wanders."""
    walk = np.cumsum(rng.normal(size=shape), axis=0) * 5e-6
    return 5e-4 * rng.normal(size=shape) + walk - walk.mean(0)


def record(gear, day, rng):
    """Record a session: an array (recordings, samples, columns), and the operating points."""
    points = [(n, t) for _ in range(REPEATS) for n in SPEEDS for t in LOADS]
    rpm, load = np.array(points, float).T
    count = len(points)
    warm = day.warmth + np.linspace(0, 0.5, count)
    friction = (1 + 0.03 * rng.normal(size=(2, count))) * [np.ones(count), np.exp(-0.03 * warm)]
    speed = rpm * np.pi / 30 * (1 + 0.001 * rng.normal(size=count))
    load = load * (1 + 0.003 * rng.normal(size=count))
    start = rng.uniform(0, TURN, count), 0.02 * rng.normal(size=count)
    motion = run(gear.drive, speed, load, friction, *start)
    grids = chipped_signals(gear, motion) if gear.chipped else grid_signals(gear, motion.angle, motion.torque)
    signals = np.concatenate([grids[:4].mean(0)[None], grids[4:]])
    signals[2] += gear.crack * np.maximum(signals[2], 0)
    elapsed = np.cumsum(rng.uniform(35, 60, count))
    zeros = (gear.zeros + day.zeros)[:, None] + day.drift[:, None] * (1 - np.exp(-elapsed / 500))
    signals = signals * (gear.gains * day.gains)[:, None, None] + zeros[:, None]
    shown = motion.angle - TURN * np.floor(motion.angle[0] / TURN)
    shape = (LENGTH, count)
    columns = [
        np.broadcast_to(np.arange(LENGTH)[:, None] / RATE, shape),
        shown + np.deg2rad(0.1) * rng.normal(size=count),
        motion.speed * 30 / np.pi + 0.02 * rng.normal(size=shape),
        motion.motor + 2e-4 * rng.normal(size=shape),
        motion.torque + 0.02 * rng.normal(size=shape),
        *(signal + noise(rng, shape) for signal in signals),
    ]
    return np.moveaxis(np.array(columns), (0, 1, 2), (2, 1, 0)), points


def write(folder, name, session, recordings, points):
    """Write the files of a session and their manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["recording,file,gear,session,n_in_rpm,T_out_nm,repeat"]
    for i, (values, (rpm, load)) in enumerate(zip(recordings, points, strict=True)):
        body = "\n".join(DIGITS % tuple(line) for line in values.tolist())
        (folder / f"rec_{i:03d}.csv").write_text(f"{COLUMNS}\n{body}\n", encoding="utf-8")
        repeat = 1 + i // (len(SPEEDS) * len(LOADS))
        lines.append(f"rec_{i:03d},rec_{i:03d}.csv,{name},{session},{rpm},{load},{repeat}")
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    """Write the two sessions and the truth of one case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--case", type=int, required=True, choices=range(20))
    given = parser.parse_args()
    healthy, changed, truth = case_of(given.seed, given.case)
    for i, (folder, gear) in enumerate((("healthy", healthy), ("again", changed))):
        rng = np.random.default_rng([given.seed, given.case, 2 + i])
        recordings, points = record(gear, new_day(rng), rng)
        write(given.out / folder, f"shell_{given.seed}_{given.case}", f"day{i + 1}", recordings, points)
    (given.out / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
