"""Which share of the change by an effect on ritz_bench the library's forms explain: python tests/benches/forms.py

Signals are free of noise. Each kind of effect is fitted to the change of s1 to s4 at orders 0 to 8 and two loads, by
size and phase on a grid and by factors of the structure that the healthy gear tells as far as it can; with a sleeve
that follows the wave generator all around, and with a wave generator that only presses.
"""

from collections.abc import Callable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from ritz_bench import cases, shell

from swgsim.chain.influence import load_amplitudes
from swgsim.effects import (
    CamForm,
    EccentricWaveGenerator,
    Effect,
    OutOfRound,
    RotatingEccentricity,
    TiltedWaveGenerator,
    TipToothCrack,
    UnevenSleeve,
    UnevenTeeth,
    WornWaveGenerator,
)  # fmt: skip
from swgsim.flexspline.flexspline import TEETH, WAVE_GENERATOR, gauge_response, solve_flex_spline
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, WAVES
from swgsim.gear.gear import Gear, WaveGenerator

LOADS, ORDERS, PHASES = (7.0, 38.5), 9, np.arange(16) * np.pi / 8
HIDDEN = ("eccentric_wave_generator", "rotating_eccentricity", "cam_form", "uneven_teeth", "worn_wave_generator")
# Standard deviations of a line [mV/V], of the factors of the structure, and of the lines of an effect, as a share of
# its largest one.
NOISE, SPREAD, FORM = 3e-4, 0.5, 0.05
LIBRARY: dict[str, tuple[Callable[[float, float], Effect], Sequence[float]]] = {
    "eccentric wave generator": (lambda size, at: EccentricWaveGenerator(r=size, theta=at), (1e-5, 2e-5, 4e-5, 8e-5)),
    "rotating eccentricity": (lambda size, at: RotatingEccentricity(e=size, phase=at), (5e-6, 1e-5, 2e-5, 4e-5)),
    "tilted wave generator": (lambda size, at: TiltedWaveGenerator(tilt=size, theta=at), (5e-4, 1e-3, 2e-3, 3e-3)),
    "cam of 3 lobes": (lambda size, at: CamForm(3, size, at), (3e-6, 6e-6, 1.2e-5)),
    "cam of 5 lobes": (lambda size, at: CamForm(5, size, at), (3e-6, 6e-6, 1.2e-5)),
    "uneven teeth": (lambda size, at: UnevenTeeth(3, size, at), (0.05, 0.1, 0.2)),
    "out of round": (lambda size, at: OutOfRound(3, size, at), (3e-6, 6e-6, 1.2e-5)),
    "uneven sleeve": (lambda size, at: UnevenSleeve(1, size, at), (0.01, 0.03, 0.1)),
    "tip crack": (lambda size, at: TipToothCrack(size, at), (0.4, 0.8)),
    "wear": (lambda size, at: WornWaveGenerator(size), (0.03, 0.06, 0.12)),
}
GEAR = Gear()
FLEX = solve_flex_spline(GEAR.flex_spline, GEAR.transmission.alpha_tooth, 100)


class Normal(NamedTuple):
    """Normal distribution of the factors of the structure, real then imaginary parts."""

    mean: np.ndarray
    covariance: np.ndarray


def by_factors(wave_generator: WaveGenerator, *effects: Effect) -> np.ndarray:
    """What each factor of the structure adds to the lines, if it is 1, and if it is i."""
    response = gauge_response(FLEX, GEAR.gauges)[:WAVES, 1:, [WAVE_GENERATOR, TEETH]]
    found = []
    for load in LOADS:
        of_map = load_amplitudes(FLEX, wave_generator, effects, EXACT_STRUCTURE, load)[..., :WAVES]
        waves = np.einsum("lpn,ngl->pgln", of_map[0] + load * of_map[1], response)
        waves = waves.reshape(*waves.shape[:2], -1)
        found.append(of_orders(np.concatenate([waves.real, -waves.imag], axis=-1)))
    return np.concatenate(found)


def of_bench(gear: cases.Gear) -> np.ndarray:
    """The lines of a gear of the bench."""
    table, angle = shell.tables(gear.structure), 2 * np.pi / 64 * np.arange(64)
    signals = [shell.signals(table, angle, np.full(64, load), 0 * angle)[1:] for load in LOADS]
    return np.concatenate([of_orders(each.T[:, :, None]) for each in signals])[:, 0]


def of_orders(signals: np.ndarray) -> np.ndarray:
    """Cosine and sine parts (line, column) of signals (angle, gauge, column)."""
    lines = np.fft.rfft(signals, axis=0, norm="forward")[:ORDERS]
    return np.concatenate([lines.real, lines.imag]).reshape(-1, signals.shape[-1])


def learned(columns: np.ndarray, healthy: np.ndarray) -> Normal:
    """The factors of the structure, given the lines of the healthy gear."""
    prior = np.repeat([1.0, 0.0], columns.shape[1] // 2)
    covariance = np.linalg.inv(columns.T @ columns / NOISE**2 + np.eye(len(prior)) / SPREAD**2)
    return Normal(covariance @ (columns.T @ healthy / NOISE**2 + prior / SPREAD**2), covariance)


def explained(factors: Normal, columns: np.ndarray, change: np.ndarray) -> tuple[float, float]:
    """Log evidence of an effect for a change, and the share of its sum of squares that the effect explains."""
    missed = change - columns @ factors.mean
    scatter = columns @ factors.covariance @ columns.T
    whole = scatter + (NOISE**2 + (FORM * np.abs(change).max()) ** 2) * np.eye(len(change))
    weighed = np.linalg.solve(whole, missed)
    log = -(missed @ weighed + np.linalg.slogdet(whole)[1]) / 2
    left = missed - scatter @ weighed
    return float(log), float(1 - left @ left / (change @ change))


def main() -> None:
    """Print the most probable kinds for every hidden effect."""
    for name in HIDDEN:
        rng, case = np.random.default_rng(0), cases.CASES.index(name)
        healthy = cases.draw_gear(rng)
        before = of_bench(healthy)
        change = of_bench(cases.break_gear(healthy, case, rng)[0]) - before
        print(name)
        for label, only in (("follows", False), ("lifts off", True)):
            wave_generator = WaveGenerator(w0=healthy.structure.wave, presses_only=only)
            sound, found = by_factors(wave_generator), []
            factors = learned(sound, before)
            for kind, (make, sizes) in LIBRARY.items():
                tried = (by_factors(wave_generator, make(*each)) - sound for each in product(sizes, PHASES))
                found.append((*max(explained(factors, columns, change) for columns in tried), kind))
            best = [f"{kind} {share:.2f} ({log:.0f})" for log, share, kind in sorted(found, reverse=True)[:4]]
            print(f"  {label:9} {', '.join(best)}", flush=True)


if __name__ == "__main__":
    main()
