"""Shapes over time in the signals of a recording: the orders, and those of an effect with random phases."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import Role, quantities
from swgsim.identification.data.beat import beat_orders
from swgsim.identification.data.features import FITTED, basis
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.storage.labelled_signals import SENSORS


def scene_of(recording: Recording, samples: slice = slice(None)) -> Scene:
    """What effects see of a recording, its time from 0."""
    angle = recording.channels["phi_in"][samples]
    load = recording.channels.get("T_out")
    held = np.full(len(angle), float(recording.point.T_out)) if load is None else load[samples]
    time = recording.time[samples] - recording.time[0]
    return Scene(time, angle, held, recording.point, recording.conditions)


def ordinary(scene: Scene, N: int | None = None) -> Float[np.ndarray, "time column"]:
    """The orders that are fitted; a straight line over time, whose ends would leak into the whole spectrum; and, of a
    gear of ratio N, what turns with its circular spline, close to some of them.
    """
    time, phi = scene.time, scene.phi_in
    beats = [] if N is None else [phi * order for order in beat_orders(N)]
    waves = [wave(angle) for angle in beats for wave in (np.cos, np.sin)]
    return np.column_stack([basis(phi, FITTED), (time - time.mean()) / float(np.ptp(time)), *waves])


def shapes(effect: Effect, scene: Scene, gauges: tuple[str, ...]) -> Float[np.ndarray, "variant gauge time"]:
    """What an effect can put on silent gauges: sums of these, whatever its random phases."""
    return np.array([_alone(each, scene, gauges) for each in _with_phases(effect)])


@lru_cache(maxsize=4096)  # the same in all recordings
def _with_phases(effect: Effect) -> tuple[Effect, ...]:
    """An effect with the random phases of which all others are sums."""
    random = [name for name, q in quantities(type(effect)).items() if q.role is Role.RANDOM]
    phases = [dict.fromkeys(random, 0.0)]
    phases += [{n: np.pi if n == name else 0.0 for n in random} for name in random[1:]]
    phases += [{n: np.pi / 2 if n == name else 0.0 for n in random} for name in random]
    return tuple(replace(effect, **each) for each in phases)


def _alone(effect: Effect, scene: Scene, gauges: tuple[str, ...]) -> Float[np.ndarray, "gauge time"]:
    """What an effect puts on silent gauges."""
    effect = effect.at(scene.point, scene.conditions)
    signals = effect.gauge(np.zeros((len(SENSORS), len(scene.time))), scene)
    others = dict.fromkeys(CHANNELS, np.zeros(len(scene.time)))
    channels = effect.acquisition(others | dict(zip(SENSORS, signals, strict=True)), scene)
    return np.array([channels[gauge] for gauge in gauges])
