"""Recordings as a sound test bench makes them, for tests that spoil them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from chain_fixtures import GEAR, SECTORS

from swgsim.chain.chain import Run, simulate_turns
from swgsim.common.seeds import generator
from swgsim.effects import Effect
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

POINTS = tuple(OperatingPoint(n, T) for n in (2000, 4000) for T in (7, 39, 70))
NOISE = 1e-3  # mV/V


@cache
def good(
    gear: Gear = GEAR,
    points: tuple[OperatingPoint, ...] = POINTS,
    effects: tuple[Effect, ...] = (),
    repeats: int = 2,
    per_turn: int = 150,
    turns: int = 12,
) -> tuple[Recording, ...]:
    """Recordings with noise, jitter of the index angle, speed ripple and a measured temperature."""
    rng = generator("good recordings", gear.number, repeats)
    runs = [
        Run(gear, point, effects, float(rng.normal(0, 0.01)), Conditions(24.0 + 0.3 * repeat, 60.0 * repeat))
        for point in points
        for repeat in range(repeats)
    ]
    recordings = simulate_turns(runs, turns + 1, per_turn, SECTORS)
    return tuple(
        replace(recorded(each, turns * per_turn, rng), name=f"{gear.number}-{i}", repeat=1 + i % repeats)
        for i, each in enumerate(recordings)
    )


def recorded(ideal: Recording, samples: int, rng: np.random.Generator) -> Recording:
    """With a slow ripple of the speed by 0.3 % and white noise on the channels."""
    time = ideal.time[:samples]
    ripple = 2 * np.pi * 3.7
    warped = time + 0.003 / ripple * (1 - np.cos(ripple * time))
    channels = {name: np.interp(warped, ideal.time, values) for name, values in ideal.channels.items()}
    noise = {"phi_in": 1e-4, "n_in": 1.0, "T_in": 2e-3, "T_out": 0.05, **dict.fromkeys(SENSORS, NOISE)}
    channels = {name: values + rng.normal(0, noise[name], samples) for name, values in channels.items()}
    return replace(ideal, time=time, channels=channels)


def with_channel(recording: Recording, name: str, values: np.ndarray) -> Recording:
    """The recording with other values of one channel."""
    return replace(recording, channels={**recording.channels, name: values})


def all_with(recordings: Sequence[Recording], name: str, factor: float) -> tuple[Recording, ...]:
    """The recordings with one channel multiplied, as if it were in another unit."""
    return tuple(with_channel(each, name, factor * each.channels[name]) for each in recordings)


def cut(recording: Recording, keep: np.ndarray) -> Recording:
    """Only the samples of a mask."""
    channels = {name: values[keep] for name, values in recording.channels.items()}
    return replace(recording, time=recording.time[keep], channels=channels)
