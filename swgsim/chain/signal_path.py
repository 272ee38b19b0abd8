"""Effects on gauges and acquisition, applied to the channels of runs."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.storage.labelled_signals import SENSORS

# Oversampling where effects make corners; the error of order lines stays below a tenth of the noise of a recording.
DENSER = 8
# Number of runs that are oversampled at once, as many as fit the processor's cache.
AT_ONCE = 32


@dataclass(frozen=True, eq=False)
class Ideal:
    """The channels of a run before effects act on gauges and acquisition.

    Attributes
    ----------
    effects : tuple of Effect
        The effects at the operating point of the run.
    scene : Scene
    channels : mapping
        All channels, arrays (time,).
    """

    effects: tuple[Effect, ...]
    scene: Scene
    channels: Mapping[str, Float[np.ndarray, " time"]]

    @property
    def sharp(self) -> bool:
        """Whether effects make corners."""
        return any(effect.sharp for effect in self.effects)


def as_seen(ideal: Ideal) -> Mapping[str, Float[np.ndarray, " time"]]:
    """The recorded channels, after the effects on gauges and acquisition."""
    signals = np.array([ideal.channels[sensor] for sensor in SENSORS])
    for effect in ideal.effects:
        signals = effect.gauge(signals, ideal.scene)
    channels: Mapping[str, np.ndarray] = {**ideal.channels, **dict(zip(SENSORS, signals, strict=True))}
    for effect in ideal.effects:
        channels = effect.acquisition(channels, ideal.scene)
    return channels


def all_as_seen(turns: Sequence[Ideal]) -> list[Mapping[str, Float[np.ndarray, " time"]]]:
    """The recorded channels of many runs of whole revolutions with equal numbers of samples.

    Runs with an effect that makes corners are oversampled. The change by their effects is filtered before it is sampled
    again, as the high orders of a corner would alias to low ones.
    """
    sharp = [ideal for ideal in turns if ideal.sharp]
    some = (sharp[i : i + AT_ONCE] for i in range(0, len(sharp), AT_ONCE))
    filtered = (found for each in some for found in _filtered(each))
    return [next(filtered) if ideal.sharp else as_seen(ideal) for ideal in turns]


def _filtered(turns: Sequence[Ideal]) -> Iterator[Mapping[str, Float[np.ndarray, " time"]]]:
    """The channels of runs with corners, from oversampled and filtered signals."""
    from scipy.signal import resample  # takes half a second to import, and few runs have corners

    names, samples = list(turns[0].channels), len(turns[0].scene.time)
    time = np.array([ideal.scene.time for ideal in turns])
    dense = np.arange(DENSER * samples) / DENSER * time[:, 1:2]
    # The angle grows from revolution to revolution; its deviation from uniform rotation is periodic.
    turning = np.array([[ideal.scene.point.omega_in * (name == "phi_in") for name in names] for ideal in turns])
    ideals = np.array([[ideal.channels[name] for name in names] for ideal in turns])
    torques = np.array([[ideal.scene.T_out] for ideal in turns])
    repeating = np.concatenate([ideals - turning[..., None] * time[:, None], torques], axis=1)
    denser = resample(repeating, DENSER * samples, axis=-1)
    denser, torques = denser[:, :-1] + turning[..., None] * dense[:, None], denser[:, -1]
    seen = np.empty_like(denser)
    for number, ideal in enumerate(turns):
        channels = dict(zip(names, denser[number], strict=True))
        scene = replace(ideal.scene, time=dense[number], phi_in=channels["phi_in"], T_out=torques[number])
        found = as_seen(replace(ideal, scene=scene, channels=channels))
        seen[number] = [found[name] for name in names]
    changed = ideals + resample(seen - denser, samples, axis=-1)
    return (dict(zip(names, each, strict=True)) for each in changed)
