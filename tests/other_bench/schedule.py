"""The recordings of a session: set points, and what they really are."""

from dataclasses import dataclass

import numpy as np

from other_bench.specimen import REFERENCE, Specimen

# Set points [rpm], [N m], each recorded so often.
SPEEDS, LOADS, REPEATS = (2000.0, 4000.0), (7.0, 39.0, 70.0), 3
# The gear warms up by so much over a session of 18 recordings, one each 50 s or so, with that time constant; estimates
# [K], [s]. Deviation of a thermometer's reading from this course [K].
WARMING, EVERY, TIME_CONSTANT, THERMOMETER = 6.0, (45.0, 55.0), 450.0, 0.2
# How well set points are reached, relative, and the angle's index, which each start of the bench finds anew [rad].
SPEED, LOAD, INDEX = 1e-3, 5e-3, np.radians(0.2)
# Frequency of the brake's slow swing [Hz].
SWING_FREQUENCY = (0.8, 2.0)


@dataclass(frozen=True)
class Run:
    """A recording to be made.

    Attributes
    ----------
    unit : Specimen
    session : str
    n, T : float
        Set points [rpm], [N m].
    repeat : int
        From 1.
    temperature, elapsed : float
        [°C], time since the session began [s].
    speed, load : float
        What the set points really are [rpm], [N m].
    c0 : float
        Angle of the output at the start [rad].
    swing : float
        Of the load [Hz].
    index : float
        Error of the angle's zero [rad].
    """

    unit: Specimen
    session: str
    n: float
    T: float
    repeat: int
    temperature: float
    elapsed: float
    speed: float
    load: float
    c0: float
    swing: float
    index: float


def session(unit: Specimen, name: str, rng: np.random.Generator) -> list[Run]:
    """Every set point so often, in an order of its own each time."""
    points = [(n, T) for n in SPEEDS for T in LOADS]
    whole = 1 - np.exp(-REPEATS * len(points) * np.mean(EVERY) / TIME_CONSTANT)
    runs, elapsed = [], 0.0
    for repeat in range(1, REPEATS + 1):
        for k in rng.permutation(len(points)):
            n, T = points[k]
            course = REFERENCE + WARMING * (1 - np.exp(-elapsed / TIME_CONSTANT)) / whole
            temperature = course + THERMOMETER * rng.standard_normal()
            runs.append(
                Run(
                    unit, name, n, T, repeat, temperature, elapsed,
                    speed=n * (1 + SPEED * rng.standard_normal()),
                    load=T * (1 + LOAD * rng.standard_normal()),
                    c0=rng.uniform(0, 2 * np.pi),
                    swing=rng.uniform(*SWING_FREQUENCY),
                    index=INDEX * rng.standard_normal(),
                )
            )  # fmt: skip
            elapsed += rng.uniform(*EVERY)
    return runs
