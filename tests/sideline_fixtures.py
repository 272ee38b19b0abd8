"""Recordings for what lies between the orders."""

import numpy as np
from loop_fixtures import POINTS, recorded, turning
from scipy.signal import lfilter

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect, Scene
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

NOISE = 1e-3


def measured(
    effects: tuple[Effect, ...], seed: int, points=POINTS, slow: float = 0.0, revolutions: float = 12
) -> list[Recording]:
    """Gauges with order 2, white and slow noise, and effects with another phase in every recording."""
    found = []
    for point in points:
        rng = generator("sidelines", seed, point.n_in_rpm, point.T_out)
        rate = 50 * point.n_in_rpm / 60
        phi = turning(point, revolutions, rate)
        load = np.full(len(phi), point.T_out)
        ideal = recorded({"phi_in": phi, "T_out": load}, point, rate)
        scene = Scene(ideal.time, phi, load, point, ideal.conditions)
        signals = 0.17 * np.cos(2 * phi + np.pi / 2 * np.arange(5)[:, None])
        for effect in (each.drawn(rng) for each in effects):
            signals = effect.gauge(signals, scene)
            signals = np.array(
                [effect.acquisition(dict(zip(SENSORS, signals, strict=True)), scene)[s] for s in SENSORS]
            )
        signals = signals + NOISE * rng.standard_normal(signals.shape)
        # A first-order wander that falls off above 1 Hz.
        decay = np.exp(-2 * np.pi / rate)
        steps = slow * np.sqrt(1 - decay**2) * rng.standard_normal((5, len(phi) + 20_000))
        signals = signals + lfilter([1], [1, -decay], steps, axis=1)[:, -len(phi) :]
        channels = {"phi_in": phi, "T_out": load, **dict(zip(SENSORS, signals, strict=True))}
        found.append(recorded(channels, point, rate))
    return found
