"""Command line: python -m frame_bench OUT --seed S --case K."""

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from .drive import RATE, simulate
from .gear import Gear, make_case, strain_signals

SAMPLES, REPEATS = 3600, 3
POINTS = tuple((rpm, load) for rpm in (2000, 3000, 4000) for load in (7, 39))
COLUMNS = "t_s,phi_in_rad,n_in_rpm,T_in_nm,T_out_nm,s0_mv_v,s1_mv_v,s2_mv_v,s3_mv_v,s4_mv_v"
DECIMALS = ("%.4f", "%.5f", "%.2f", "%.5f", "%.3f") + ("%.6f",) * 5
GAUGE_NOISE = 1e-3  # mV/V
RING_PATTERN = np.array([0.0, 1.0, -1.0, 1.0, -1.0])  # two waves around the collar, which the torque bridge cancels


def remount(gear: Gear, rng: np.random.Generator) -> Gear:
    """The gear on another day: amplifiers warmed up anew and bridges balanced again."""
    return replace(gear, gains=gear.gains * (1 + rng.normal(0, 5e-4, 5)), zeros=gear.zeros + rng.normal(0, 1e-3, 5))


def ringing(gear: Gear, rng: np.random.Generator) -> np.ndarray:
    """A lightly damped shell mode that noise excites, with the rms `gear.ring`."""
    pole = np.exp((-2 * np.pi * 3.0 + 2j * np.pi * gear.ring_frequency) / RATE)
    start = 4000
    line = lfilter([1.0], [1.0, -2 * pole.real, abs(pole) ** 2], rng.normal(size=start + SAMPLES))[start:]
    return gear.ring * line / line.std()


def record(gear: Gear, rng: np.random.Generator) -> tuple[list[np.ndarray], list[tuple]]:
    """All recordings of a session and their rows of the manifest."""
    runs = [(rpm, load, repeat) for repeat in range(1, REPEATS + 1) for rpm, load in POINTS]
    rpm, load = (np.array(x, float) for x in list(zip(*runs, strict=True))[:2])
    count, time = len(runs), np.arange(SAMPLES) / RATE
    elapsed = 60 + 45 * np.arange(count)
    warming = 2.5 * (1 - np.exp(-elapsed / 500))
    room = rng.normal(24, 0.4)
    speed = rpm * 2 * np.pi / 60 * (1 + rng.normal(0, 1e-3, count))
    motion = simulate(
        gear.drive,
        speed,
        load * (1 + rng.normal(0, 3e-3, count)),
        1 + rng.normal(0, 0.03, count),
        rng.uniform(0, 2 * np.pi, (2, count)),
        SAMPLES,
    )
    tables, rows = [], []
    for run in range(count):
        phases = rng.uniform(0, 2 * np.pi, 2)
        signals = strain_signals(
            gear, motion.cam_angle[:, run], motion.torque_out[:, run], motion.angle_out[:, run], time, phases[0]
        )
        signals += gear.zeros + gear.thermal * (warming[run] + room - 24)
        signals += gear.hum * np.sin(2 * np.pi * 50 * time + phases[1])[:, None]
        signals += ringing(gear, rng)[:, None] * RING_PATTERN + rng.normal(0, GAUGE_NOISE, signals.shape)
        angle = motion.angle_in[:, run] + rng.normal(0, np.radians(0.1))
        angle -= 2 * np.pi * np.floor(angle[0] / (2 * np.pi))
        noise = rng.normal(size=(3, SAMPLES))
        tables.append(
            np.column_stack(
                [
                    time,
                    angle,
                    motion.speed_in[:, run] * 30 / np.pi + 0.02 * noise[0],
                    motion.torque_in[:, run] + 2e-4 * noise[1],
                    motion.torque_out[:, run] + 0.03 * noise[2],
                    signals,
                ]
            )
        )
        temperature = round(room + warming[run] + rng.normal(0, 0.1), 2)
        rows.append((*runs[run], temperature, int(elapsed[run])))
    return tables, rows


def write_session(folder: Path, session: str, unit: str, gear: Gear, rng: np.random.Generator) -> None:
    """Record a session and write its files."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["recording,file,gear,session,n_in_rpm,T_out_nm,repeat,temperature_c,elapsed_s"]
    tables, rows = record(gear, rng)
    for index, (table, row) in enumerate(zip(tables, rows, strict=True)):
        name = f"rec_{index:03d}"
        np.savetxt(folder / f"{name}.csv", table, DECIMALS, ",", header=COLUMNS, comments="")
        lines.append(",".join(map(str, (name, f"{name}.csv", unit, session, *row))))
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Write one case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--case", type=int, choices=range(20), required=True)
    options = parser.parse_args()
    first, second, truth = make_case(options.seed, options.case)
    streams = [np.random.default_rng([options.seed, options.case, number]) for number in (2, 3, 4)]
    unit = f"frame{options.seed}_{options.case}"
    write_session(options.out / "healthy", "day1", unit, first, streams[0])
    write_session(options.out / "again", "day2", unit, remount(second, streams[1]), streams[2])
    (options.out / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    main()
