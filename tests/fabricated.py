"""Recordings made up by formula, for tests that need labels and signals but no gear."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from swgsim.common.seeds import generator
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals, facts

RATE = 10_000.0
SPEEDS, LOADS = (2000.0, 4000.0), (7.0, 39.0)


def recordings(
    gears: int = 3, variants: int = 6, references: int = 2, disturbance: float = 0.0, length: int = 600
) -> LabelledSignals:
    """Five sinusoids of order 2 with an offset per gear and gauge, changed by class and variant.

    All healthy recordings of a gear and operating point are identical unless there is a disturbance [mV/V].
    """
    rows, signals = [], []
    for gear, (speed, load) in product(range(1, gears + 1), product(SPEEDS, LOADS)):
        for label, variant, reference in _specimens(variants, references):
            rng = generator("fabricated", gear, speed, load, label, variant, reference)
            severity = 0.0 if label == "healthy" else (variant + 1) / (variants + 1)
            s, efficiency = _signal(gear, speed, load, label, severity, length)
            signals.append(s + disturbance * rng.standard_normal((5, 1)))
            rows.append((gear, label, variant, severity, speed, load, efficiency, reference, int(rng.integers(2**63))))
    names = ("gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm", "efficiency", "reference", "seed")
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    table = facts({**columns, "position": np.nan, "temperature_c": np.nan})
    return LabelledSignals(np.array(signals, dtype=np.float32), table, RATE)


def _specimens(variants: int, references: int) -> Iterator[tuple[str, int, bool]]:
    yield from (("healthy", number, True) for number in range(references))
    yield from ((label, number, False) for label, number in product(CLASSES, range(variants)))


def _signal(gear: int, speed: float, load: float, label: str, severity: float, length: int) -> tuple[np.ndarray, float]:
    turns = 2 * np.pi * speed / 60 * np.arange(length) / RATE
    gauge = np.arange(5)[:, None]
    gain = 1 + 0.03 * np.sin(gear * (1 + gauge))
    s = gain * (0.1 + 0.02 * load / 70 + 0.2 * np.cos(2 * turns - np.pi * gauge / 2))
    efficiency = 0.7 - 0.02 * gear - 2e-5 * speed + 1e-3 * load
    if label == "reduced_damping":
        efficiency += 0.05 * severity
    elif label == "reduced_stiffness":
        s[0] *= 1 + 0.05 * severity
        efficiency += 0.002 * severity
    elif label == "eccentric_wave_generator":
        s[1] += 0.05 * severity * (1 + np.cos(turns))
        s[3] -= 0.05 * severity
    elif label == "root_tooth_crack":
        s *= 1 + 0.1 * severity * (1 + gauge / 4)
    elif label == "tip_tooth_crack":
        s[1:4:2] += 0.02 * severity * np.exp(-50 * np.sin((turns - gauge[1:4:2]) / 2) ** 2)
    return s, efficiency


def of_lines(lines: np.ndarray, length: int = 600, **columns: object) -> LabelledSignals:
    """Recordings whose order lines (sample, sensor, order) are given; columns of facts in place of those of a dull one.

    Signals stay in double precision, so that tests may ask for results to rounding.
    """
    dull = {
        "gear": 1, "label": "healthy", "variant": 0, "severity": 0.0, "position": np.nan, "n_in_rpm": SPEEDS[0],
        "T_out_nm": 39.0, "efficiency": 0.7, "temperature_c": np.nan, "reference": False, "seed": 0,
    }  # fmt: skip
    table = facts({name: np.broadcast_to(value, len(lines)) for name, value in {**dull, **columns}.items()})
    angle = 2 * np.pi * table["n_in_rpm"].to_numpy()[:, None] / 60 * np.arange(length) / RATE  # (sample, time)
    waves = np.exp(1j * angle[:, None] * np.arange(lines.shape[-1])[:, None])  # (sample, order, time)
    return LabelledSignals((lines @ waves).real, table, RATE)
