"""The simulation chain (Fig. 2): input/output model, flex spline and gauges in a row, for many runs at once."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
from jaxtyping import Float
from threadpoolctl import threadpool_limits

from swgsim.acquisition import Window
from swgsim.dynamics import Drive
from swgsim.effects.base import Effect
from swgsim.flexspline import solve_flex_spline
from swgsim.gear import Gear, OperatingPoint
from swgsim.influence import InfluenceMap, harmonics, influence_map
from swgsim.motion import Motion, advance, run, steady_state

SECTORS = 100

# Orders of an influence map below this share of the largest one are left out.
NEGLIGIBLE = 1e-8


@dataclass(frozen=True)
class Run:
    """One run of the chain.

    Attributes
    ----------
    gear : Gear
    point : OperatingPoint
    effects : tuple of Effect
    start_angle : float
        Wave-generator angle at which the window opens [rad].
    """

    gear: Gear
    point: OperatingPoint
    effects: tuple[Effect, ...] = ()
    start_angle: float = 0.0

    @property
    def affected_gear(self) -> Gear:
        """The gear with the parameters that the effects change."""
        return reduce(lambda gear, effect: effect.gear(gear), self.effects, self.gear)


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
    """

    signals: Float[np.ndarray, "run 5 time"]
    motion: Motion
    of_run: np.ndarray

    @property
    def efficiency(self) -> Float[np.ndarray, " run"]:
        """P_out / P_in over whole revolutions."""
        return self.motion.efficiency[self.of_run]


@threadpool_limits.wrap(limits=1)
def simulate(runs: Sequence[Run], window: Window, sectors: int = SECTORS) -> Simulation:
    """Simulate many runs; what runs have in common is computed once.

    One thread: the matrices are small, and the result must not depend on the number of cores.

    Parameters
    ----------
    runs : sequence of Run
    window : Window
    sectors : int
        Sectors of the flex spline's truss, even.

    Returns
    -------
    Simulation
        Ideal signals: noise, quantisation and disturbance are for the acquisition.
    """
    if not runs:
        raise ValueError(
            "no runs to simulate: the grid is empty; give it gears, classes, variants and operating points"
        )
    gears = [r.affected_gear for r in runs]
    motions, of_run = _distinct([(g.transmission, r.point, r.start_angle) for g, r in zip(gears, runs, strict=True)])
    structures, structure_of_run = _distinct([_structure(g, r.effects) for g, r in zip(gears, runs, strict=True)])
    motion = _motion(motions, window)
    maps = [
        influence_map(solve_flex_spline(hat, alpha_tooth, sectors), wave_generator, gauges, effects)
        for hat, alpha_tooth, wave_generator, gauges, effects in structures
    ]
    signals = np.empty((len(runs), 5, window.samples))
    for m in range(len(motions)):
        rows = np.flatnonzero(of_run == m)
        angle, torque = motion.phi_in[m, : window.samples], motion.T_out[m, : window.samples]
        signals[rows] = evaluate([maps[s] for s in structure_of_run[rows]], angle, torque)
    return Simulation(signals, motion, of_run)


def evaluate(
    maps: Sequence[InfluenceMap], psi: Float[np.ndarray, " time"], T_out: Float[np.ndarray, " time"]
) -> Float[np.ndarray, "map 5 time"]:
    """The signals of several structures along one motion, s = A(psi) + T_out B(psi)."""
    coefficients = np.stack([m.coefficients for m in maps])
    kept = _significant(coefficients, np.abs(T_out).max())
    turns = harmonics(psi, kept)
    real = np.concatenate([turns.real, -turns.imag])
    weights = np.concatenate([coefficients[..., kept].real, coefficients[..., kept].imag], axis=-1)
    A, B = np.moveaxis((weights.reshape(-1, len(real)) @ real).reshape(*weights.shape[:-1], -1), 1, 0)
    return A + T_out * B


def _significant(coefficients: np.ndarray, T_out: float) -> np.ndarray:
    """The orders that matter relative to the largest signal; sound gears have even ones only, and few of them."""
    size = np.abs(coefficients) * np.array([1.0, T_out])[:, None, None]
    size = size.max(axis=tuple(range(size.ndim - 1)))
    return np.flatnonzero(size > NEGLIGIBLE * size.max())


def _structure(gear: Gear, effects: Sequence[Effect]) -> tuple:
    """All that an influence map depends on, but for the mesh."""
    touching = tuple(filter(_touches_structure, effects))
    return gear.flex_spline, gear.transmission.alpha_tooth, gear.wave_generator, gear.gauges, touching


def _touches_structure(effect: Effect) -> bool:
    """Whether an effect overrides a place of the flex spline rather than of the drive alone."""
    places = ("wave_generator", "mesh", "cracks")
    return any(getattr(type(effect), place) is not getattr(Effect, place) for place in places)


def _distinct(keys: list) -> tuple[list, np.ndarray]:
    """The distinct keys in order of appearance, and the index of each key among them."""
    index: dict = {}
    where = np.array([index.setdefault(key, len(index)) for key in keys])
    return list(index), where


def _motion(motions: list, window: Window) -> Motion:
    """Steady motion of each distinct (transmission, operating point, start angle) over the window."""
    drive = Drive([m[0] for m in motions], [m[1] for m in motions])
    start = np.array([m[2] for m in motions])
    state = steady_state(drive)
    if np.any(start):
        state = advance(drive, state, start)
    return run(drive, state, 1 / window.rate, window.samples)
