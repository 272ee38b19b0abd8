"""The simulation chain (Fig. 2): input/output model, flex spline and gauges in a row, for many runs at once."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, reduce

import numpy as np
from jaxtyping import Float
from threadpoolctl import threadpool_limits

from swgsim.chain.influence import FINE_ANGLES, InfluenceMap, harmonics
from swgsim.chain.motion import Motion
from swgsim.chain.signal_path import Ideal, all_as_seen, as_seen
from swgsim.chain.steady_state_cache import Driven, drive_of, one_turn
from swgsim.chain.steady_window import over_window
from swgsim.chain.structure import Structure, map_of
from swgsim.effects.base import Effect, Scene, overrides
from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

SECTORS = 100

# Gauge signals of several structures along one motion: maps, angle [rad] and torque [N m] over time.
Along = Callable[[Sequence[InfluenceMap], np.ndarray, np.ndarray], np.ndarray]

# Orders of an influence map below this share of the largest one are omitted.
NEGLIGIBLE_MAP_ORDER = 1e-8


@dataclass(frozen=True)
class Run:
    """One run of the chain.

    Attributes
    ----------
    gear : Gear
    point : OperatingPoint
    effects : tuple of Effect
    start_angle : float
        Wave-generator angle at the start of the window, from gauge s1 [rad].
    conditions : Conditions
    """

    gear: Gear
    point: OperatingPoint
    effects: tuple[Effect, ...] = ()
    start_angle: float = 0.0
    conditions: Conditions = field(default_factory=Conditions)

    @cached_property
    def acting(self) -> tuple[Effect, ...]:
        """The effects at the operating point and under the conditions of the run."""
        return tuple(effect.at(self.point, self.conditions) for effect in self.effects)

    @cached_property
    def driving(self) -> tuple[Effect, ...]:
        """The effects that add torques."""
        return tuple(effect for effect in self.acting if overrides(effect, "drive"))

    @cached_property
    def affected_gear(self) -> Gear:
        """The gear with its parameters changed by the effects."""
        changing = tuple(effect for effect in self.acting if overrides(effect, "gear"))
        return _affected(self.gear, changing) if changing else self.gear


@lru_cache(maxsize=4096)
def _affected(gear: Gear, effects: tuple[Effect, ...]) -> Gear:
    """A gear changed by effects; many runs share it."""
    return reduce(lambda gear, effect: effect.gear(gear), effects, gear)


@dataclass(frozen=True)
class Simulation:
    """What the chain puts out.

    Attributes
    ----------
    signals : array (run, sensor, time)
        [mV/V].
    motion : Motion
        Of the distinct motions.
    of_run : array (run,)
        Which motion belongs to each run.
    seen : mapping
        Of the runs whose effects act on gauges or acquisition: number of the run to all its channels.
    """

    signals: Float[np.ndarray, "run 5 time"]
    motion: Motion
    of_run: np.ndarray
    seen: Mapping[int, Mapping[str, np.ndarray]] = field(default_factory=dict)

    @property
    def efficiency(self) -> Float[np.ndarray, " run"]:
        """P_out / P_in over whole revolutions."""
        return self.motion.efficiency[self.of_run]


@threadpool_limits.wrap(limits=1)
def simulate(runs: Sequence[Run], window: Window, sectors: int = SECTORS) -> Simulation:
    """Simulate many runs; motions and structures that runs share are computed once.

    It uses one thread: the matrices are small, and the result must not depend on the number of cores.

    Parameters
    ----------
    runs : sequence of Run
    window : Window
    sectors : int
        Sectors of the flex spline's truss, even.

    Returns
    -------
    Simulation
        Ideal signals, without noise, quantisation and disturbance of the acquisition.
    """
    driven, of_run = _driven(runs)
    motion = over_window(*drive_of(driven), 1 / window.rate, window.samples)
    signals = _gauge_signals(runs, motion, of_run, window.samples, sectors, interpolate)
    ideal = Simulation(signals, motion, of_run)
    seen = {
        i: as_seen(_before_effects(each, window.time, ideal, i))
        for i, each in enumerate(runs)
        if any(overrides(effect, "gauge", "acquisition") for effect in each.acting)
    }
    for i, channels in seen.items():
        signals[i] = [channels[sensor] for sensor in SENSORS]
    return Simulation(signals, motion, of_run, seen)


@threadpool_limits.wrap(limits=1)
def simulate_turns(
    runs: Sequence[Run], revolutions: int, points: int, sectors: int = SECTORS, search: bool = True
) -> list[Recording]:
    """Recordings of whole revolutions of the wave generator in the steady state.

    One revolution is computed, or taken from a cache, and repeated. Then effects on gauges and acquisition act on all
    of them in time.

    Parameters
    ----------
    runs : sequence of Run
    revolutions : int
    points : int
        Samples per revolution.
    sectors : int
        Sectors of the flex spline's truss, even.
    search : bool
        As for :func:`~swgsim.chain.settling.steady_revolution`.
    """
    driven, of_run = _driven(runs)
    motion = one_turn(driven, points, search)
    signals = np.tile(_gauge_signals(runs, motion, of_run, points, sectors, evaluate), revolutions)
    simulation = Simulation(signals, motion.repeated(revolutions), of_run)
    steps = np.arange(revolutions * points) / points
    times = [steps * 2 * np.pi / each.point.omega_in for each in runs]
    ideal = [_before_effects(*each, simulation, i) for i, each in enumerate(zip(runs, times, strict=True))]
    return [
        Recording(f"{i}", f"{each.gear.number}", "1", each.point, 1, time, seen, each.conditions)
        for i, (each, time, seen) in enumerate(zip(runs, times, all_as_seen(ideal), strict=True), 1)
    ]


def _before_effects(each: Run, time: Float[np.ndarray, " time"], simulation: Simulation, i: int) -> Ideal:
    """A run of a simulation before effects act on gauges and acquisition."""
    channels = channels_of(simulation, i, len(time))
    transmitted = simulation.motion.T_out[simulation.of_run[i], : len(time)]
    return Ideal(each.acting, Scene(time, channels["phi_in"], transmitted, each.point, each.conditions), channels)


def _driven(runs: Sequence[Run]) -> tuple[list[Driven], np.ndarray]:
    """The distinct motions, and the index of the motion of each run."""
    if not runs:
        raise ValueError(
            "no runs to simulate: the grid is empty; give it gears, classes, variants and operating points"
        )
    return distinct([Driven(r.affected_gear.transmission, r.point, r.driving, r.start_angle) for r in runs])


def _gauge_signals(
    runs: Sequence[Run], motion: Motion, of_run: np.ndarray, samples: int, sectors: int, along: Along
) -> Float[np.ndarray, "run 5 time"]:
    """The bridge signals of every run along its motion [mV/V]."""
    structures, structure_of_run = distinct([Structure.of(r.affected_gear, r.acting, r.point.T_out) for r in runs])
    maps = [map_of(structure, sectors) for structure in structures]
    signals = np.empty((len(runs), 5, samples))
    for m in range(len(motion.phi_in)):
        rows = np.flatnonzero(of_run == m)
        angle, torque = motion.phi_in[m, :samples], motion.T_out[m, :samples]
        signals[rows] = along([maps[s] for s in structure_of_run[rows]], angle, torque)
    return signals


def channels_of(simulation: Simulation, i: int, samples: int) -> dict[str, np.ndarray]:
    """All channels of a run: phi_in [rad], n_in [rpm], T_in and T_out [N m], s0 to s4 [mV/V]."""
    if i in simulation.seen:
        return {name: values[:samples].copy() for name, values in simulation.seen[i].items()}
    motion, m = simulation.motion, simulation.of_run[i]
    return {
        "phi_in": motion.phi_in[m, :samples].copy(),
        "n_in": motion.omega_in[m, :samples] * 60 / (2 * np.pi),
        "T_in": motion.T_in[m, :samples].copy(),
        "T_out": motion.T_flange[m, :samples].copy(),
        **dict(zip(SENSORS, simulation.signals[i, :, :samples], strict=True)),
    }


def evaluate(
    maps: Sequence[InfluenceMap], psi: Float[np.ndarray, " time"], T_out: Float[np.ndarray, " time"]
) -> Float[np.ndarray, "map 5 time"]:
    """Gauge signals of several structures along one motion, s = A(psi) + T_out B(psi) [mV/V].

    Parameters
    ----------
    maps : sequence of InfluenceMap
    psi : array (time,)
        Angle of the wave generator, phi_in [rad].
    T_out : array (time,)
        Output torque [N m].
    """
    kept = _significant(maps, np.abs(T_out).max())
    turns = harmonics(psi, kept)
    real = np.concatenate([turns.real, -turns.imag])
    coefficients = np.array([m.coefficients[..., kept] for m in maps])
    weights = np.concatenate([coefficients.real, coefficients.imag], axis=-1)
    A, B = np.moveaxis((weights.reshape(-1, len(real)) @ real).reshape(*weights.shape[:-1], -1), 1, 0)
    return A + T_out * B


def interpolate(
    maps: Sequence[InfluenceMap], psi: Float[np.ndarray, " time"], T_out: Float[np.ndarray, " time"]
) -> Float[np.ndarray, "map 5 time"]:
    """The same as :func:`evaluate` for many times, by cubics through four of the FINE_ANGLES angles of a map.

    A wave of order k errs by 0.023 (2 pi k / FINE)^4 of its amplitude at most: 3e-11 for order 2, 5e-6 for order 40.
    """
    place = psi * (FINE_ANGLES / (2 * np.pi))
    low = np.floor(place)
    x = place - low
    four = low.astype(int) % FINE_ANGLES + np.arange(4)[:, None]
    weights = np.stack([-x * (x - 1) * (x - 2), 3 * (x * x - 1) * (x - 2), -3 * x * (x + 1) * (x - 2), x * (x * x - 1)])
    weights = weights.T[:, None] / 6
    signals = np.empty((len(maps), 5, len(psi)))
    for signal, each in zip(signals, maps, strict=True):
        A, B = np.matmul(weights, np.take(each.fine, four.T, axis=0))[:, 0].T.reshape(2, 5, -1)
        np.add(A, T_out * B, out=signal)
    return signals


def _significant(maps: Sequence[InfluenceMap], T_out: float) -> np.ndarray:
    """Orders above NEGLIGIBLE relative to the largest one; sound gears have few, and only even ones."""
    size = (np.array([m.largest for m in maps]).max(axis=0) * [[1.0], [T_out]]).max(axis=0)
    return np.flatnonzero(size > NEGLIGIBLE_MAP_ORDER * size.max())


def distinct(keys: list) -> tuple[list, np.ndarray]:
    """The distinct keys in order of appearance, and the index of each key among them."""
    index: dict = {}
    where = np.array([index.setdefault(key, len(index)) for key in keys])
    return list(index), where
