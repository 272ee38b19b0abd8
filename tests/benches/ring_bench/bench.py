"""One bench: a gear with its gauges, days in the laboratory, and the files of their recordings."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from .drive import RATE, RPM, SAMPLES, Conditions, Drive, simulate
from .ring import CAM_ANGLES, TORQUES, Ring, gauge_table

POINTS = [(speed, load) for speed in (2400, 3200, 4000) for load in (7, 39)]
REPEATS = 3
PAUSE = 40.0  # seconds between the beginnings of two recordings
COLUMNS = "t_s,phi_in_rad,n_in_rpm,T_in_nm,T_out_nm,s0_mv_v,s1_mv_v,s2_mv_v,s3_mv_v,s4_mv_v"
FORMATS = ["%.4f", "%.5f", "%.2f", "%.5f", "%.3f"] + ["%.6f"] * 5


@dataclass(frozen=True)
class Gauges:
    """Errors of the five bridges; each array is over s0 to s4."""

    gains: np.ndarray
    zeros: np.ndarray  # [mV/V]
    shifts: np.ndarray  # position errors [rad]
    warming: np.ndarray  # change of the zeros [mV/V per K]


@dataclass(frozen=True)
class Bench:
    """A gear on its test bench."""

    ring: Ring
    drive: Drive
    gauges: Gauges
    creep: float = 0.0  # the cam slips back on its shaft by so much in a session at 39 N m [rad]
    name: str = field(default="gear1")


def day_conditions(rng: np.random.Generator) -> tuple[Conditions, np.ndarray]:
    """Conditions of the 18 recordings of a day, and the time at which each begins."""
    speed, load = np.tile(np.array(POINTS, dtype=float), (REPEATS, 1)).T
    count = len(speed)
    elapsed = 60 + PAUSE * np.arange(count) + rng.uniform(0, 5, count)
    temperature = 24.5 + rng.normal(0, 0.4) + 1.5 * (1 - np.exp(-elapsed / 500))
    conditions = Conditions(
        speed=speed * RPM * (1 + 0.001 * rng.normal(size=count)),
        load=load * (1 + 0.003 * rng.normal(size=count)),
        friction=1 + 0.03 * rng.normal(size=count),
        temperature=temperature,
        angle=rng.uniform(0, 2 * np.pi, count),
        spline=rng.uniform(0, 2 * np.pi, count),
    )
    return conditions, elapsed


def interpolate(table: np.ndarray, angle: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Signals at each angle of the cam and torque: periodic splines over angle, a polynomial over torque."""
    closed = np.concatenate([table, table[:1]])
    over_angle = CubicSpline(np.append(CAM_ANGLES, 2 * np.pi), closed, bc_type="periodic")(angle % (2 * np.pi))
    weights = []
    for i, node in enumerate(TORQUES):
        others = np.delete(TORQUES, i)
        weights.append(np.prod((torque[..., None] - others) / (node - others), axis=-1))
    return np.einsum("...jg,j...->...g", over_angle, np.array(weights))


def noise(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Noise of the gauge amplifiers over the samples (second axis) in mV/V: white, and a slow random walk."""
    return 1e-3 * rng.normal(size=shape) + 2e-5 * np.cumsum(rng.normal(size=shape), axis=1)


def record(bench: Bench, day: str, folder: Path, rng: np.random.Generator) -> None:
    """Write manifest and recordings of one day."""
    now, elapsed = day_conditions(rng)
    motion = simulate(bench.drive, now)
    count = len(elapsed)
    slip = bench.creep * np.cumsum(now.load) / np.sum(now.load)
    signals = interpolate(
        gauge_table(bench.ring, bench.gauges.shifts), motion["phi_in"] - slip[:, None], motion["T_out"]
    )
    gains = bench.gauges.gains * (1 + 0.001 * rng.normal(size=5))
    zeros = bench.gauges.zeros + 3e-4 * rng.normal(size=5)
    zeros = zeros + bench.gauges.warming * (now.temperature - 25)[:, None] + 5e-5 * rng.normal(size=(count, 5))
    signals = signals * gains + zeros[:, None] + noise(rng, signals.shape)
    shown = {
        "phi_in": motion["phi_in"] + np.radians(0.1) * rng.normal(size=(count, 1)),
        "n_in": motion["n_in"] + 0.02 * rng.normal(size=(count, SAMPLES)),
        "T_in": motion["T_in"] + 2e-4 * rng.normal(size=(count, SAMPLES)),
        "T_out": motion["T_out"] + 0.03 * rng.normal(size=(count, SAMPLES)),
    }
    shown["phi_in"] -= 2 * np.pi * np.floor(shown["phi_in"][:, :1] / (2 * np.pi))

    folder.mkdir(parents=True, exist_ok=True)
    rows = ["recording,file,gear,session,n_in_rpm,T_out_nm,repeat,temperature_c,elapsed_s"]
    for i in range(count):
        speed, load = POINTS[i % len(POINTS)]
        repeat = 1 + i // len(POINTS)
        name = f"rec_{i:03d}"
        data = np.column_stack([np.arange(SAMPLES) / RATE, *(shown[key][i] for key in shown), signals[i]])
        np.savetxt(folder / f"{name}.csv", data, fmt=FORMATS, delimiter=",", header=COLUMNS, comments="")
        rows.append(
            f"{name},{name}.csv,{bench.name},{day},{speed},{load},{repeat},{now.temperature[i]:.2f},{elapsed[i]:.1f}"
        )
    (folder / "manifest.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
