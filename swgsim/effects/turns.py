"""Revolutions and time within a recording, for effects on gauges and acquisition."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Channels, Samples, Scene
from swgsim.storage.labelled_signals import SENSORS


def samples_per_turn(scene: Scene) -> float:
    """Samples in one revolution at the speed of the operating point."""
    return float(2 * np.pi / (scene.point.omega_in * (scene.time[1] - scene.time[0])))


def mean_over_turns(signals: Float[np.ndarray, "sensor time"], scene: Scene) -> Float[np.ndarray, "sensor 1"]:
    """Mean of each signal over the largest whole number of revolutions."""
    turn = samples_per_turn(scene)
    turns = max(1, int(len(scene.time) / turn + 1e-6))
    return signals[:, : round(turns * turn)].mean(axis=1, keepdims=True)


def since_session(scene: Scene) -> Samples:
    """Time since the session began [s]."""
    return scene.conditions.elapsed + scene.time


def on_gauges(channels: Channels, change: Callable[[int, Samples], Samples]) -> Channels:
    """The channels, each gauge signal replaced by ``change(sensor, signal)``."""
    return {**channels, **{name: change(s, channels[name]) for s, name in enumerate(SENSORS)}}
