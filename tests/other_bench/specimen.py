"""A unit of the gear with its gauges and what it is mounted to, as drawn; a healthy one, or with something wrong."""

import zlib
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Complex, Float

from other_bench.hat import Hat

# Kinematic error at the output: amplitude [rad] and phase of each order; estimates within catalogue accuracy.
KINEMATIC = {1: (0.4e-4, 0.3), 2: (0.7e-4, 1.1), 4: (0.3e-4, 2.0)}
# At which gains and zeros are the unit's own [°C].
REFERENCE = 25.0


@dataclass(frozen=True)
class Crack:
    """Share of the stiffness or force that is lost, and where around the flex spline [rad]."""

    share: float = 0.0
    angle: float = 0.0


@dataclass(frozen=True, eq=False)
class Specimen:
    """One unit; everything from `eccentricity` on is zero for a healthy one.

    Attributes
    ----------
    w0 : float
        Radial deflection by the wave generator [m].
    k1, b0, b1, mu, k2, b2, b3, theta_b, N, alpha, J_in, J_out
        Of the paper's eqs. (2) to (6), SI; alpha is the gear-tooth angle.
    kinematic : array (3,)
        Kinematic error at the output, amplitude times exp(i phase) of each order of KINEMATIC [rad].
    gain, offset : array (gauge,)
        Of s0 to s4 [-], [mV/V].
    position, arms : array (4,)
        Error of the place of s1 to s4, and of the four half bridges of s0 [rad].
    grid_angle : array (gauge,)
        Error of the direction [rad].
    hat : Hat
    eccentricity : complex
        Static offset of the wave generator, size times exp(i direction) [m].
    root, tip : Crack
        Hoop stiffness lost over three tooth pitches, tooth force lost over four teeth.
    moment : complex
        Tilting moment that turns with the output, size times exp(i direction at the start) [N m].
    sticky : float
        Friction of the input's bearing [N m].
    hum : array (gauge,)
        50 Hz [mV/V].
    breathing : complex
        Order 4 in s1, and inverted in s3, at 70 N m, amplitude times exp(i phase) [mV/V].
    """

    w0: float
    k1: float
    b0: float
    b1: float
    mu: float
    kinematic: Complex[np.ndarray, " 3"]
    gain: Float[np.ndarray, " gauge"]
    offset: Float[np.ndarray, " gauge"]
    position: Float[np.ndarray, " 4"]
    arms: Float[np.ndarray, " 4"]
    grid_angle: Float[np.ndarray, " gauge"]
    k2: float = 8.7e6
    b2: float = 0.0
    b3: float = 0.07
    theta_b: float = 0.6
    N: int = 100
    alpha: float = np.pi / 6
    J_in: float = 1.2e-4
    J_out: float = 1.0
    hat: Hat = field(default_factory=Hat)
    eccentricity: complex = 0j
    root: Crack = Crack()
    tip: Crack = Crack()
    moment: complex = 0j
    sticky: float = 0.0
    hum: Float[np.ndarray, " gauge"] = field(default_factory=lambda: np.zeros(5))
    breathing: complex = 0j


def draw(name: str) -> Specimen:
    """The healthy unit of a name, always the same.

    Its nominal values are those that the model under test starts from, which is what a maker knows; how far units
    scatter around them is an estimate.
    """
    rng = np.random.default_rng([zlib.crc32(name.encode()), 77])

    def near(value: float, share: float) -> float:
        return value * (1 + rng.uniform(-share, share))

    def gauges(values: list[float], sd: float) -> Float[np.ndarray, " gauge"]:
        return np.array(values) + sd * rng.standard_normal(5)

    k1, b0, b1, mu = (near(nominal, 0.08) for nominal in (4733.0, 1.403, 0.52, 0.0562))
    w0 = near(0.2159e-3, 0.01)
    errors = [near(size, 0.15) * np.exp(1j * (phase + rng.uniform(-0.3, 0.3))) for size, phase in KINEMATIC.values()]
    gain = np.array([1.004, 0.997, 1.006, 1.002, 0.995]) * (1 + 0.004 * rng.standard_normal(5))
    offset = gauges([0.0021, -0.0038, 0.0052, 0.0016, -0.0027], 0.003)
    position = gauges([0.001, -0.004, 0.006, 0.003, -0.002], 0.003)
    arms = position[0] + 0.002 * rng.standard_normal(4)
    grid_angle = gauges([0.002, 0.005, -0.003, -0.006, 0.004], 0.002)
    return Specimen(w0, k1, b0, b1, mu, np.array(errors), gain, offset, position[1:], arms, grid_angle)
