"""A joint of random size. Ranges were set before any answer was seen.

- Torque, speed, acceleration: data sheets of UR10e (330, 150 and 56 N m; 2.1 to 3.1 rad/s), KUKA LBR iiwa (320 to 40
  N m; 1.3 to 3.1 rad/s), Franka Panda (87 and 12 N m; 2.2 and 2.6 rad/s; 7.5 to 20 rad/s^2), Kinova Gen3 (54 and
  34 N m).
- Friction: estimate after the no-load running and starting torques in the catalogues of Harmonic Drive SE (CSG-2A).
- Temperature and load: A. C. Bittencourt and S. Gunnarsson, Static friction in a robot joint: modeling and
  identification of load and temperature effects, ASME J. Dyn. Syst. Meas. Control 134, 051013, 2012.
- Stiffness, hardening and kinematic error: estimate after the same catalogues (K1, K2, K3; positioning accuracy).
- Encoders: 17 to 20 bit at the output (RLS AksIM-2), or 14 bit on the motor. Noise and zeros: estimates, in shares of
  the rated current and torque.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from robots.plant import Drive, Plant
from robots.trajectories import PROGRAMMES, Limits

FOREIGN = ("lugre", "temperature", "backlash", "seals", "hardening", "ripple")
KINDS = ("healthy", *FOREIGN)


@dataclass(frozen=True)
class Truth:
    """What a joint is, and how it was recorded.

    Attributes
    ----------
    kind : str
        One of :data:`KINDS`.
    size : mapping
        Size of the hidden physics, by name with its unit; empty for a healthy joint.
    plant, drive, limits
    phase : float
        Angle of the centre of mass against the joint's zero [rad].
    signal : str
        Signal to explain: ``current`` or ``T_sensor``.
    rated : float
        Rated torque [N m].
    rigid_factor : float or None
        Factor of the recorded rigid-body torque; None if none was recorded.
    payloads : bool
        Whether the payload differs from day to day; the rigid-body model knows it.
    carried : bool
        Whether another joint about a parallel axis carries this one; it stands, differently on every day.
    ratio_known : bool
    constant_known : float or None
        Torque constant that the log declares, if any: within 5 % [N m/A].
    viscous_rate : float
        Relative fall of the viscous friction with temperature [1/K].
    warming : float
        Rise of the temperature in a long day [K].
    current_noise, torque_noise, current_zero, torque_zero : float
        Standard deviations [A, N m]: white noise of each sample, zero of each run.
    sensor_bandwidth : float
        Of the torque sensor [Hz].
    late : int
        Cycles by which the logged speed is late.
    rate : int
        [Hz], of the log.
    programme : str
        One of :data:`robots.trajectories.PROGRAMMES`.
    """

    kind: str
    size: Mapping[str, float]
    plant: Plant
    drive: Drive
    limits: Limits
    phase: float
    signal: str
    rated: float
    rigid_factor: float | None
    payloads: bool
    carried: bool
    ratio_known: bool
    constant_known: float | None
    viscous_rate: float
    warming: float
    current_noise: float
    torque_noise: float
    current_zero: float
    torque_zero: float
    sensor_bandwidth: float
    late: int
    rate: int
    programme: str


def draw(kind: str, rng: np.random.Generator) -> Truth:
    """A joint with the hidden physics of a kind."""
    if kind not in KINDS:
        raise ValueError(f"kind={kind} is unknown: choose from {', '.join(KINDS)}")
    rated, fastest = _log(rng, 10, 300), rng.uniform(1.2, 3.2)
    acceleration = _log(rng, 3, 15)
    inertia, share = 0.5 * rated / acceleration, rng.uniform(0.2, 0.7)  # of the motor: estimate
    level_axis = rng.random() < 0.8
    rated_current = _log(rng, 1.5, 12)
    plant = Plant(
        motor=share * inertia,
        link=(1 - share) * inertia,
        gravity=rng.uniform(0.1, 0.45) * rated if level_axis else 0.0,
        constant=rated / rated_current,
        coulomb=rng.uniform(0.03, 0.15) * rated,
        viscous=rng.uniform(0.03, 0.15) * rated / fastest,
        width=_log(rng, 0.5e-3, 5e-3) if rng.random() < 0.5 else 0.0,  # estimate: of a lubricated contact
        ratio=float(rng.choice([50, 80, 100, 101, 120, 160])),
    )
    on_motor = rng.random() < 0.5
    drive = Drive(
        resolution=2 * np.pi / (2**14 * plant.ratio if on_motor else 2 ** rng.integers(17, 21)),
        cut_off=_log(rng, 20, 100),
        bandwidth=2 * np.pi * rng.uniform(1.5, 4),
        gravity_known=rng.uniform(0.85, 1.1),
        limit=2 * rated,
    )
    programme = str(rng.choice(list(PROGRAMMES)))
    with_rigid = rng.random() < 0.5
    plant, size, viscous_rate, warming = _with(kind, plant, rated, rng)
    return Truth(
        kind, size, plant, drive, _limits(programme, fastest, 0.8 * acceleration, rng),
        phase=rng.uniform(-np.pi, np.pi),
        signal="T_sensor" if kind == "healthy" and rng.random() < 0.3 else "current",
        rated=rated,
        rigid_factor=float(rng.normal(1, 0.05)) if with_rigid else None,
        payloads=with_rigid and level_axis and rng.random() < 0.5,
        carried=level_axis and rng.random() < 0.3,
        ratio_known=rng.random() < 0.8,
        constant_known=plant.constant * rng.uniform(0.95, 1.05) if rng.random() < 0.5 else None,
        viscous_rate=viscous_rate,
        warming=warming,
        current_noise=_log(rng, 0.003, 0.02) * rated_current,
        torque_noise=_log(rng, 0.0005, 0.003) * rated,
        current_zero=_log(rng, 0.001, 0.005) * rated_current,
        torque_zero=_log(rng, 0.001, 0.01) * rated,
        sensor_bandwidth=_log(rng, 100, 1000),
        late=int(rng.integers(0, 3)),
        rate=int(rng.choice([100, 125, 200, 250, 500, 1000])),
        programme=programme,
    )  # fmt: skip


def _limits(programme: str, fastest: float, acceleration: float, rng: np.random.Generator) -> Limits:
    """Amplitude from 0.03 rad to two revolutions, where a period lasts at most 30 s at full speed."""
    most = fastest * 30 / 2 / np.pi if programme in ("sines", "chirps", "fourier", "mixed") else 4 * np.pi
    return Limits(_log(rng, 0.03, min(most, 4 * np.pi)), fastest, acceleration)


def _with(
    kind: str, plant: Plant, rated: float, rng: np.random.Generator
) -> tuple[Plant, dict[str, float], float, float]:
    """The joint with one piece of hidden physics, its size, and fall of the viscous friction [1/K] and warming [K]."""
    # Twist at the rated torque, of gear, bearing and structure: 1 to 3 mrad (catalogue: gear alone 0.3 to 1 mrad).
    twist = _log(rng, 1e-3, 3e-3)
    soft = plant._replace(stiffness=rated / twist)
    if kind == "lugre":
        excess, stribeck, bent = rng.uniform(0.2, 0.8), _log(rng, 0.01, 0.1), _log(rng, 1e-4, 1e-3)
        stiction = plant.coulomb * (1 + excess)
        size = {"stiction_n_m": stiction - plant.coulomb, "stribeck_rad_s": stribeck, "bending_rad": bent}
        changed = plant._replace(width=0.0, stiction=stiction, stribeck=stribeck, bristle=stiction / bent)
        return changed, size, 0.0, 0.0
    if kind == "temperature":  # halves in 17 to 35 K
        fall, warming = rng.uniform(0.02, 0.04), rng.uniform(5, 25)
        return plant, {"fall_per_k": fall, "warming_k": warming}, fall, warming
    if kind == "backlash":  # 1 to 10 arc minutes
        gap = _log(rng, 0.3e-3, 3e-3)
        return soft._replace(gap=gap), {"gap_rad": gap}, 0.0, 0.0
    if kind == "seals":
        share = rng.uniform(0.02, 0.08)
        return plant._replace(load_friction=share), {"friction_per_load": share}, 0.0, 0.0
    if kind == "hardening":  # tangent at the rated torque 1.6 to 2.8 times that at no load: catalogue K1, K2, K3
        share = rng.uniform(0.2, 0.6)
        cubic = share * soft.stiffness / twist**2
        return soft._replace(cubic=cubic), {"cubic_share": share, "stiffness_n_m_rad": soft.stiffness}, 0.0, 0.0
    if kind == "ripple":  # 0.35 to 2 arc minutes from peak to peak: catalogue
        error = _log(rng, 0.05e-3, 0.3e-3)
        return soft._replace(error=error), {"error_rad": error}, 0.0, 0.0
    return plant, {}, 0.0, 0.0


def _log(rng: np.random.Generator, least: float, most: float) -> float:
    """Uniform on the logarithm."""
    return float(np.exp(rng.uniform(np.log(least), np.log(most))))
