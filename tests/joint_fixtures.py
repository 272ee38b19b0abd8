"""A simulated robot joint by formulas of its own: runs at steady speeds, and trajectories under load."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import cont2discrete, lfilter

from swgsim.common.seeds import generator
from swgsim.joint.recording import JointRecording

SPEEDS = (0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0)
# The filter of the torque sensor is solved on a grid so many times as fine as the recording's.
FINER = 8
# Time constant of the slow part of the noise [s], well within a stretch.
SLOWNESS = 0.05
TORQUE_NOISE, CURRENT_NOISE = 0.01, 0.03
COULOMB, VISCOUS = 0.4, 0.5
PER_TORQUE = 0.1


@dataclass(frozen=True)
class Wave:
    """``size`` cos(order q - phase)."""

    order: float
    size: float
    phase: float = 0.7

    def at(self, q: np.ndarray) -> np.ndarray:
        return self.size * np.cos(self.order * q - self.phase)


@dataclass(frozen=True)
class Hidden:
    """What a joint does that the textbook does not say; nothing, by default.

    ``corner`` [Hz] and ``damping`` are of the second-order filter that the ripple goes through. ``stribeck`` is a
    friction and the speed at which 37 % of it are left, ``sublinear`` is in front of |omega|^(2/3), ``presliding`` a
    friction and the distance over which it builds up. ``load`` is the friction of one N m, which builds up over 2 mrad.
    ``scatter`` is the standard deviation of the current's zero from run to run.
    """

    ripple: tuple[Wave, ...] = ()
    corner: float = 0.0
    damping: float = 0.7
    cogging: tuple[Wave, ...] = ()
    tight: tuple[Wave, ...] = ()
    load: float = 0.0
    presliding: tuple[float, float] = (0.0, 1.0)
    stribeck: tuple[float, float] = (0.0, 1.0)
    sublinear: float = 0.0
    quadratic: float = 0.0
    asymmetric: float = 0.0
    gravity: float = 0.0
    inertia: float = 0.0
    scatter: float = 0.0


NOTHING = Hidden()


def coloured(rng: np.random.Generator, number: int, rate: float, size: float) -> np.ndarray:
    """Noise of standard deviation ``size``, half of its power white and half slow."""
    keep = np.exp(-1 / (SLOWNESS * rate))
    start = rng.normal(size=1)
    slow, _ = lfilter([np.sqrt(1 - keep**2)], [1, -keep], rng.normal(size=number), zi=keep * start)
    return size * np.sqrt(0.5) * (rng.normal(size=number) + slow)


def filtered(signal: np.ndarray, step: float, corner: float, damping: float) -> np.ndarray:
    """Response of a second-order system that begins at rest; its input runs straight between samples."""
    w = 2 * np.pi * corner
    numerator, denominator, _ = cont2discrete(([w**2], [1, 2 * damping * w, w**2]), step, method="foh")
    return signal[0] + lfilter(numerator[0], denominator, signal - signal[0])


def strain(q: np.ndarray, distance: float) -> np.ndarray:
    """Share of the friction of a bristle that bends over a distance before it slides, from its foot's place."""
    foot, found = q[0], []
    for place in q.tolist():
        foot = min(max(foot, place - distance), place + distance)
        found.append((place - foot) / distance)
    return np.array(found)


def friction(hidden: Hidden, q: np.ndarray, omega: np.ndarray, load: np.ndarray) -> np.ndarray:
    """That of a joint [A]."""
    sense, speed = np.tanh(omega / 0.01), np.abs(omega)
    size, v_s = hidden.stribeck
    wet = COULOMB + VISCOUS * speed + size * np.exp(-((speed / v_s) ** 2))
    wet += hidden.sublinear * speed ** (2 / 3) + hidden.quadratic * speed**2
    wet += sum(wave.at(q) for wave in hidden.tight)
    bristle, distance = hidden.presliding
    return (
        sense * wet
        + (hidden.load * np.abs(load) * strain(q, 2e-3) if hidden.load else 0.0)
        + (bristle * strain(q, distance) if bristle else 0.0)
        + hidden.asymmetric * speed
    )


def steady(
    speed: float, seed: object, hidden: Hidden = NOTHING, session: str = "A", rate: float = 500.0, seconds: float = 4.0
) -> JointRecording:
    """A run at one speed, with a torque sensor whose zero is another one in every run."""
    rng = generator("simulated joint", session, speed, seed)
    before = int(0.5 * rate)
    number = int(seconds * rate) + before
    fine = rng.uniform(0, 2 * np.pi) + speed * np.arange(number * FINER) / (rate * FINER)
    torque = 0.1 * np.cos(fine) + 0.05 * np.sin(fine)
    ripple = sum((wave.at(fine) for wave in hidden.ripple), np.zeros(len(fine)))
    if hidden.corner:
        ripple = filtered(ripple, 1 / (rate * FINER), hidden.corner, hidden.damping)
    torque = (torque + ripple)[::FINER][before:]
    q = fine[::FINER][before:]
    omega = np.full(len(q), speed)
    current = 0.05 + 0.02 * np.cos(q) + friction(hidden, q, omega, np.zeros(len(q)))
    current += sum(wave.at(q) for wave in hidden.cogging) + hidden.scatter * rng.normal()
    signals = {
        "q": q,
        "omega": omega + 0.003 * rng.normal(size=len(q)),
        "T_sensor": torque + 0.2 * rng.normal() + coloured(rng, len(q), rate, TORQUE_NOISE),
        "current": current + coloured(rng, len(q), rate, CURRENT_NOISE),
    }
    time = np.arange(len(q)) / rate
    return JointRecording(f"{session} {speed}", "simulated", "joint", session, time, signals, gear_ratio=100.0)


def sessions(
    seed: object, hidden: Hidden = NOTHING, names: str = "AB", speeds: tuple[float, ...] = SPEEDS, **how: float
) -> tuple[JointRecording, ...]:
    """Runs at some speeds on some days."""
    return tuple(steady(speed, seed, hidden, name, **how) for name in names for speed in speeds)


def trajectory(
    number: int,
    seed: object,
    hidden: Hidden = NOTHING,
    weight: float = 40.0,
    rate: float = 100.0,
    seconds: float = 25.0,
) -> JointRecording:
    """A sum of sines under gravity; on a level axis without ``weight`` [N m]."""
    rng = generator("simulated trajectory", number, seed)
    time = np.arange(int(seconds * rate)) / rate
    w = 2 * np.pi * np.arange(1, 6) / seconds
    size, shift = rng.uniform(0.15, 0.5, 5) / np.sqrt(np.arange(1, 6)), rng.uniform(0, 2 * np.pi, 5)
    angle = np.outer(time, w) + shift
    q, omega, acceleration = (
        part @ (size * w**power) for power, part in enumerate((np.sin(angle), np.cos(angle), -np.sin(angle)))
    )
    q = q + rng.uniform(-1, 1)
    load = weight * np.cos(q) + 2.0 * acceleration
    current = 0.03 + PER_TORQUE * load + friction(hidden, q, omega, load)
    current += hidden.gravity * np.sin(q) + hidden.inertia * acceleration
    current += sum(wave.at(q) for wave in hidden.cogging)
    signals = {
        "q": q,
        "omega": omega + 0.002 * rng.normal(size=len(q)),
        "current": current + coloured(rng, len(q), rate, CURRENT_NOISE),
        "T_rigid": load,
    }
    return JointRecording(f"run {number}", "simulated", "joint", f"run {number}", time, signals, gear_ratio=101.0)


def upright(
    number: int, seed: object, size: float = 0.0, corner: float = 60.0, damping: float = 0.4, *, held: bool = True
) -> JointRecording:
    """A joint with an upright axis whose arm reaches out and back, with an inertia J from 2 to 8 kg m^2, and a wave of
    order 202 that comes through a spring to the arm, in proportion to 1 / J, or if it is not ``held`` as it is.
    """
    level = trajectory(number, seed, weight=0.0)
    q, folded = level.signals["q"], trajectory(number + 10, seed).signals["q"]
    J = 2 + 6 * np.cos(folded) ** 2
    omega = np.gradient(q, level.time)
    load = np.gradient(J * omega, level.time)
    x = 202 * omega / (2 * np.pi) * np.sqrt(J) / corner
    answer = 1 / (1 - x**2 + 2j * damping * x) / J if held else 1.0
    current = level.signals["current"] + PER_TORQUE * (load - level.signals["T_rigid"])
    current = current + size * (np.exp(1j * (202 * q - 0.7)) * answer).real
    signals = {**level.signals, "current": current, "T_rigid": load}
    return replace(level, signals=signals, posture=folded[None])


def trajectories(seed: object, hidden: Hidden = NOTHING, **how: float) -> tuple[JointRecording, ...]:
    """Four of them, each a session of its own."""
    return tuple(trajectory(number, seed, hidden, **how) for number in range(4))
