"""Write a healthy gear's recordings and those of another day: python -m ritz_bench OUT --seed S --case K."""

import argparse
import json
from pathlib import Path

import numpy as np

from ritz_bench.cases import CASES, break_gear, draw_gear
from ritz_bench.drive import SAMPLES, STEP, Runs, move, sines
from ritz_bench.shell import signals, tables

POINTS = [(speed, torque) for speed in (2000, 3000, 4000) for torque in (7, 39)]  # rpm, N m
REPEATS, PAUSE = 3, 40.0  # recordings per point, s from one recording to the next
WHIRL = 0.43  # whirls per revolution
COLUMNS = {"t_s": 4, "phi_in_rad": 5, "n_in_rpm": 2, "T_in_nm": 5, "T_out_nm": 3} | {f"s{k}_mv_v": 6 for k in range(5)}
NOISE = np.array([2e-5, 0.03, 3e-4, 0.03, *[5e-4] * 5])  # of the columns after the time, in their units


def draw_runs(rng):
    """Draw the operating points of a session with their scatter from recording to recording."""
    points = np.array(POINTS * REPEATS, float)
    count = len(points)
    return Runs(
        speed=points[:, 0] * 2 * np.pi / 60 * rng.normal(1, 0.001, count),
        torque=points[:, 1] * rng.normal(1, 0.003, count),
        friction=rng.normal(1, 0.03, count),
        start=rng.uniform(0, 2 * np.pi, count),
        drift=rng.uniform(-0.002, 0.002, count),
        bend=rng.uniform(0, 1, count),
    )


def measure(gear, rng):
    """Record one session of a gear.

    Returns
    -------
    numpy.ndarray
        Values (recording, column, sample).
    """
    runs = draw_runs(rng)
    angle, speed, motor, torque = move(gear.drive, runs)
    shape = angle + sines((gear.drive.joint,), angle)[0]
    phase = rng.uniform(0, 2 * np.pi, (len(angle), 1))
    gauges = signals(tables(gear.structure), shape, torque, WHIRL * shape + phase)
    warming = 1 - np.exp(-np.arange(len(angle)) * PAUSE / 600)
    zeros = gear.zeros + rng.normal(0, 3e-4, 5) + warming[:, None] * rng.normal(0, 6e-4, 5)
    zeros = zeros + rng.normal(0, 2.5e-4, zeros.shape)
    gains = gear.gains * rng.normal(1, 5e-4, 5)
    gauges = gauges * gains[:, None, None] + zeros.T[:, :, None]
    encoder = angle + np.radians(0.1) * rng.standard_normal((len(angle), 1))
    encoder = encoder - 2 * np.pi * np.floor(encoder[:, :1] / 2 / np.pi)
    motor, torque = motor * rng.normal(1, 0.001) + rng.normal(0, 3e-4), torque * rng.normal(1, 5e-4)
    values = np.stack([encoder, speed * 30 / np.pi, motor, torque, *gauges], axis=1)
    return values + NOISE[:, None] * rng.standard_normal(values.shape)


def write(folder, gear, session, values):
    """Write the manifest and the recordings of a session."""
    folder.mkdir(parents=True, exist_ok=True)
    manifest = ["recording,file,gear,session,n_in_rpm,T_out_nm,repeat"]
    form = ",".join(f"%.{digits}f" for digits in COLUMNS.values())
    time = np.arange(SAMPLES) * STEP
    for k, value in enumerate(values):
        speed, torque = POINTS[k % len(POINTS)]
        name = f"rec_{k:03d}"
        manifest.append(f"{name},{name}.csv,{gear},{session},{speed},{torque},{k // len(POINTS) + 1}")
        table = np.vstack([time, value]).T
        np.savetxt(folder / f"{name}.csv", table, fmt=form, header=",".join(COLUMNS), comments="")
    (folder / "manifest.csv").write_text("\n".join(manifest) + "\n")


def main():
    """Simulate a case and write its two sessions and its truth."""
    parser = argparse.ArgumentParser(prog="ritz_bench", description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--case", type=int, choices=range(len(CASES)), required=True)
    given = parser.parse_args()
    unit, first, second = (np.random.default_rng([given.seed, given.case, k]) for k in range(3))
    gear = draw_gear(unit)
    other, truth = break_gear(gear, given.case, unit)
    name = f"ritz{given.seed}_{given.case}"
    write(given.out / "healthy", name, "day1", measure(gear, first))
    write(given.out / "again", name, "day2", measure(other, second))
    (given.out / "truth.json").write_text(json.dumps(truth, indent=2) + "\n")


if __name__ == "__main__":
    main()
