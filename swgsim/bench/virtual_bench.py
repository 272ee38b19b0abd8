"""A virtual test bench: recordings of a gear with all channels, repeats, sessions and the errors of a real bench.

It leaves out ripple of the drive, an eccentric encoder, grease that thins as it warms, and imperfections of a healthy
wave generator, as a model of the gear lacks them. They are effects, which the caller adds like all others.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from swgsim.bench.scatter import Bench, Session
from swgsim.chain.chain import Run, channels_of, simulate
from swgsim.common.checks import require, require_integer
from swgsim.common.seeds import generator
from swgsim.effects import OutputPosition
from swgsim.effects.base import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Recordings that are simulated at once: more share the work of each time step, fewer need less memory.
BLOCK = 36


@dataclass(frozen=True)
class Sessions:
    """Plan of the recordings.

    Attributes
    ----------
    points : tuple of OperatingPoint
    repeats : int
        Recordings of every operating point in a session: each series has all points once.
    sessions : int
    revolutions : int
        Revolutions of the wave generator in a recording; 12 have whole periods of the orders 1/2, 1/3 and 1/4.
    pause : float
        Time between the starts of two recordings [s].
    warming : float
        Rise of the gear's temperature over a session [K].
    unsteady : float
        Scatter of the temperature between recordings, as a standard deviation [K].
    thermometer : float
        Error of the measured temperature, as a standard deviation [K].
    name : str
        Name of the session; of several ones, the part before their numbers.

    Raises
    ------
    ValueError
        If there are no or duplicate operating points, or a number is beyond its limits.
    """

    points: tuple[OperatingPoint, ...]
    repeats: int = 3
    sessions: int = 1
    revolutions: int = 12
    pause: float = 60.0
    warming: float = 6.0
    unsteady: float = 0.5
    thermometer: float = 0.3
    name: str = ""

    def __post_init__(self) -> None:
        owner = "the sessions"
        if not self.points or len(set(self.points)) < len(self.points):
            raise ValueError(f"operating points of {owner} are {self.points}, must be one or more, each once")
        for name, high in (("repeats", 1000), ("sessions", 100), ("revolutions", 1000)):
            require_integer(owner, name, getattr(self, name), low=1, high=high)
        for name, highest in (("pause", 1e5), ("warming", 40.0), ("unsteady", 10.0), ("thermometer", 20.0)):
            require(owner, name, getattr(self, name), low=0, high=highest)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the sessions."""
        if self.sessions == 1:
            return (self.name or "1",)
        return tuple(f"{self.name}-{number}".removeprefix("-") for number in range(1, self.sessions + 1))

    def __len__(self) -> int:
        return self.sessions * self.repeats * len(self.points)


@dataclass(frozen=True)
class Instruments:
    """Noise of the instruments, without the white noise of the gauges; estimates.

    Attributes
    ----------
    flange_in, flange_out : float
        White noise of the torque flanges [N m].
    encoder : float
        White noise of the angle [rad].
    speed : float
        White noise of the speed reading [rpm].
    wander : float
        Slow noise of every gauge amplifier, as a standard deviation [mV/V]; the 1/f part of physics.md AC5.
    memory : float
        Correlation time of the slow noise [s], a first-order autoregression that exceeds the white noise below 20 Hz.

    Raises
    ------
    ValueError
        If a number is beyond its limits.
    """

    flange_in: float = 0.002
    flange_out: float = 0.05
    encoder: float = 2e-5
    speed: float = 0.5
    wander: float = 2e-4
    memory: float = 0.05

    def __post_init__(self) -> None:
        limits = (0.1, 2.0, 0.01, 50.0, 0.1, 100.0)
        for f, high in zip(fields(self), limits, strict=True):
            require("the instruments", f.name, getattr(self, f.name), low=1e-6 if f.name == "memory" else 0, high=high)


def record_sessions(
    gear: Gear,
    effects: Sequence[Effect],
    plan: Sessions,
    bench: Bench,
    *,
    seed: int,
    window: Window,
    sectors: int,
    name: str = "",
    instruments: Instruments | None = None,
    progress: Callable[[int], object] = lambda recordings: None,
) -> tuple[Recording, ...]:
    """Recordings of one gear.

    Parameters
    ----------
    gear : Gear
        The actual unit.
    effects : sequence of Effect
        All effects of the unit, declared or not; an additional one at the end changes no random draw of the others.
    plan : Sessions
    bench : Bench
        Errors between recordings; a unit's imperfections belong to `effects`, the temperature to `plan`.
    seed : int
    window : Window
        Sampling rate and step of the converter; its noise and number of samples are not used.
    sectors : int
        Sectors of the flex spline's truss.
    name : str
        Name of the gear, by default its number.
    instruments : Instruments, optional
    progress : callable, optional
        Called with the number of recordings that were finished since the last call.

    Returns
    -------
    tuple of Recording
    """
    found: list[Recording] = []
    for session in plan.names:
        biases = biases_of(bench, seed, session)
        planned = _planned(gear, effects, plan, bench, seed, session)
        for first in range(0, len(planned), BLOCK):
            block = planned[first : first + BLOCK]
            longest = max(_samples(each.point, plan.revolutions, window.rate) for each in block)
            simulation = simulate([each.run for each in block], replace(window, samples=longest), sectors)
            for i, each in enumerate(block):
                samples = _samples(each.point, plan.revolutions, window.rate)
                rng = generator("virtual bench acquisition", seed, session, each.name)
                channels = _measured(
                    channels_of(simulation, i, samples), each.run, bench, biases, window,
                    instruments or Instruments(), rng,
                )  # fmt: skip
                conditions = each.run.conditions
                shown = replace(conditions, temperature=conditions.temperature + rng.normal(0, plan.thermometer))
                time = np.arange(samples) / window.rate
                owner = name or str(gear.number)
                found.append(Recording(each.name, owner, session, each.point, each.repeat, time, channels, shown))
            progress(len(block))
    return tuple(found)


def biases_of(bench: Bench, seed: int, session: str) -> Session:
    """Biases of all recordings of a session, as :func:`record_sessions` draws them."""
    return bench.session(generator("virtual bench session", seed, session))


@dataclass(frozen=True)
class Planned:
    """A planned recording and its actual run."""

    session: str
    point: OperatingPoint
    repeat: int
    run: Run

    @property
    def name(self) -> str:
        """Name of the recording."""
        return f"{self.session}-{self.point.n_in_rpm:g}rpm-{self.point.T_out:g}Nm-{self.repeat}"


def _planned(
    gear: Gear, effects: Sequence[Effect], plan: Sessions, bench: Bench, seed: int, session: str
) -> list[Planned]:
    """The recordings of a session in order of time; the gear warms up."""
    order = [(point, repeat) for repeat in range(1, plan.repeats + 1) for point in plan.points]
    found = []
    for number, (point, repeat) in enumerate(order):
        which = (seed, session, float(point.n_in_rpm), float(point.T_out), repeat)
        rng = generator("virtual bench", *which)
        warmer = plan.warming * number / max(len(order) - 1, 1) + rng.normal(0, plan.unsteady)
        conditions = Conditions(bench.reference_temperature + warmer, number * plan.pause)
        acting = [effect.drawn(generator("virtual bench effect", *which, i)) for i, effect in enumerate(effects)]
        found.append(Planned(session, point, repeat, _run(gear, acting, point, conditions, bench, rng)))
    return found


def _samples(point: OperatingPoint, revolutions: int, rate: float) -> int:
    """Number of samples for some revolutions at the set speed, as a bench records for a fixed time."""
    return int(np.ceil(revolutions * 60 / point.n_in_rpm * rate))


def _run(
    gear: Gear,
    acting: Sequence[Effect],
    point: OperatingPoint,
    conditions: Conditions,
    bench: Bench,
    rng: np.random.Generator,
) -> Run:
    """The actual run."""
    real = OperatingPoint(
        point.n_in_rpm * (1 + rng.normal(0, bench.speed)), point.T_out * (1 + rng.normal(0, bench.load))
    )
    whereabouts = OutputPosition(rng.uniform(0, bench.output_angle))
    return Run(gear, real, (*acting, whereabouts), rng.normal(0, bench.index_angle), conditions)


def _measured(
    ideal: Mapping[str, np.ndarray],
    run: Run,
    bench: Bench,
    biases: Session,
    window: Window,
    instruments: Instruments,
    rng: np.random.Generator,
) -> dict[str, np.ndarray]:
    """The measured channels."""
    samples = len(ideal["phi_in"])

    def white(level: float) -> np.ndarray:
        return level * rng.standard_normal(samples)

    drift = rng.normal(0, bench.zero_drift, (len(SENSORS), 1))
    signals = np.array([ideal[sensor] for sensor in SENSORS]) + drift
    signals = signals + _wander(instruments, window.rate, samples, rng)
    signals = replace(window, noise=bench.noise, samples=samples).acquire(signals, rng)
    return {
        # The angle is zero at the trigger.
        "phi_in": ideal["phi_in"] - run.start_angle + white(instruments.encoder),
        "n_in": ideal["n_in"] + white(instruments.speed),
        "T_in": ideal["T_in"] + biases.T_in + rng.normal(0, bench.flange_in) + white(instruments.flange_in),
        "T_out": ideal["T_out"] + biases.T_out + rng.normal(0, bench.flange_out) + white(instruments.flange_out),
        **dict(zip(SENSORS, signals, strict=True)),
    }


def _wander(
    instruments: Instruments, rate: float, samples: int, rng: np.random.Generator
) -> Float[np.ndarray, "sensor time"]:
    """Slow noise of every gauge amplifier, stationary from the first sample."""
    from scipy.signal import lfilter  # takes half a second to import, and every command imports this module

    kept = np.exp(-1 / (rate * instruments.memory))
    steps = rng.standard_normal((len(SENSORS), samples))
    steps[:, 1:] *= np.sqrt(1 - kept**2)
    return instruments.wander * lfilter([1.0], [1.0, -kept], steps, axis=1)
