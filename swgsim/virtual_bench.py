"""A virtual test bench: recordings of a gear with all channels, repeats, sessions and the errors of a real bench."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from swgsim.acquisition import Window
from swgsim.bench import Bench, Session
from swgsim.chain import Run, channels_of, simulate
from swgsim.conditions import Conditions
from swgsim.effects import OutputPosition
from swgsim.effects.base import Effect
from swgsim.gear import Gear, OperatingPoint
from swgsim.recording import Recording
from swgsim.recordings import SENSORS
from swgsim.seeds import generator


@dataclass(frozen=True)
class Sessions:
    """What is recorded.

    Attributes
    ----------
    points : tuple of OperatingPoint
    repeats : int
        Recordings of every operating point in every session.
    sessions : int
    revolutions : int
        Of the wave generator in every recording; 12 bring the orders 1/2, 1/3 and 1/4 onto lines of the spectrum.
    pause : float
        Time from one recording to the next [s].
    warming : float
        Temperature that the gear gains over a session [K].
    unsteady : float
        Its scatter from one recording to the next, as a standard deviation [K].
    thermometer : float
        Error of its reading, as a standard deviation [K].
    """

    points: tuple[OperatingPoint, ...]
    repeats: int = 3
    sessions: int = 1
    revolutions: int = 12
    pause: float = 60.0
    warming: float = 6.0
    unsteady: float = 0.5
    thermometer: float = 0.3


@dataclass(frozen=True)
class Instruments:
    """Noise of the instruments beside the gauges; estimates.

    Attributes
    ----------
    flange_in, flange_out : float
        White noise of the torque flanges [N m].
    encoder : float
        White noise of the angle [rad].
    speed : float
        White noise of the speed reading [rpm].
    """

    flange_in: float = 0.002
    flange_out: float = 0.05
    encoder: float = 2e-5
    speed: float = 0.5


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
) -> tuple[Recording, ...]:
    """Recordings of one gear.

    Parameters
    ----------
    gear : Gear
        The unit as it is.
    effects : sequence of Effect
        All that acts on it, declared or not.
    plan : Sessions
    bench : Bench
        Errors from one recording to the next; a unit's imperfections are among `effects`.
    seed : int
    window : Window
        Sampling rate, noise and step of the converter; the number of samples follows from the revolutions.
    sectors : int
        Sectors of the flex spline's truss.
    name : str
        Of the gear; its number if empty.
    instruments : Instruments, optional
    """
    planned = []
    for session in range(1, plan.sessions + 1):
        order = [(point, repeat) for repeat in range(1, plan.repeats + 1) for point in plan.points]
        for number, (point, repeat) in enumerate(order):
            rng = generator("virtual bench", seed, session, point.n_in_rpm, point.T_out, repeat)
            warmer = plan.warming * number / max(len(order) - 1, 1) + rng.normal(0, plan.unsteady)
            conditions = Conditions(bench.reference_temperature + warmer, number * plan.pause)
            planned.append(Planned(f"{session}", point, repeat, _run(gear, effects, point, conditions, bench, rng)))
    longest = max(samples_of(each, plan.revolutions, window.rate) for each in planned)
    simulation = simulate([each.run for each in planned], replace(window, samples=longest), sectors)
    found = []
    for i, each in enumerate(planned):
        rng = generator("virtual bench acquisition", seed, each.session, each.name)
        biases = bench.session(generator("virtual bench session", seed, each.session))
        samples = samples_of(each, plan.revolutions, window.rate)
        ideal = channels_of(simulation, i, samples)
        channels = _measured(ideal, each.run, bench, biases, window, instruments or Instruments(), rng)
        conditions = each.run.conditions
        shown = conditions.temperature + rng.normal(0, plan.thermometer)
        time = np.arange(samples) / window.rate
        found.append(
            Recording(
                each.name, name or str(gear.number), each.session, each.point, each.repeat, time, channels,
                replace(conditions, temperature=shown),
            )
        )  # fmt: skip
    return tuple(found)


@dataclass(frozen=True)
class Planned:
    """A recording as it was planned, and the run as it really takes place."""

    session: str
    point: OperatingPoint
    repeat: int
    run: Run

    @property
    def name(self) -> str:
        """Name of the recording."""
        return f"{self.session}-{self.point.n_in_rpm:g}rpm-{self.point.T_out:g}Nm-{self.repeat}"


def samples_of(planned: Planned, revolutions: int, rate: float) -> int:
    """Samples that hold so many revolutions."""
    return int(np.ceil(revolutions * 60 / planned.run.point.n_in_rpm * rate))


def _run(
    gear: Gear,
    effects: Sequence[Effect],
    point: OperatingPoint,
    conditions: Conditions,
    bench: Bench,
    rng: np.random.Generator,
) -> Run:
    """The run as it really takes place."""
    real = OperatingPoint(
        point.n_in_rpm * (1 + rng.normal(0, bench.speed)), point.T_out * (1 + rng.normal(0, bench.load))
    )
    whereabouts = OutputPosition(rng.uniform(0, bench.output_angle))
    acting = (*(effect.drawn(rng) for effect in effects), whereabouts)
    return Run(gear, real, acting, rng.normal(0, bench.index_angle), conditions)


def _measured(
    ideal: Mapping[str, np.ndarray],
    run: Run,
    bench: Bench,
    biases: Session,
    window: Window,
    instruments: Instruments,
    rng: np.random.Generator,
) -> dict[str, np.ndarray]:
    """The channels as the instruments show them."""
    samples = len(ideal["phi_in"])

    def white(level: float) -> np.ndarray:
        return level * rng.standard_normal(samples)

    drift = rng.normal(0, bench.zero_drift, (len(SENSORS), 1))
    signals = np.array([ideal[sensor] for sensor in SENSORS]) + drift
    signals = replace(window, noise=bench.noise, samples=samples).acquire(signals, rng)
    return {
        # The angle is counted from where the trigger saw the index.
        "phi_in": ideal["phi_in"] - run.start_angle + white(instruments.encoder),
        "n_in": ideal["n_in"] + white(instruments.speed),
        "T_in": ideal["T_in"] + biases.T_in + rng.normal(0, bench.flange_in) + white(instruments.flange_in),
        "T_out": ideal["T_out"] + biases.T_out + rng.normal(0, bench.flange_out) + white(instruments.flange_out),
        **dict(zip(SENSORS, signals, strict=True)),
    }
