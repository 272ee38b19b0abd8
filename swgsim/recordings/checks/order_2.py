"""Order-2 line of each gauge: the two lobes of the wave generator, the largest line of healthy and faulty gears."""

import numpy as np
from jaxtyping import Complex, Float

from swgsim.recordings.checks.angle import angle_is_sound
from swgsim.recordings.files.assembly import unwrapped
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

FITTED_ORDERS = 4


def angle_of(recording: Recording) -> Float[np.ndarray, " time"]:
    """The recorded angle if it is sound, otherwise that of the set speed [rad]."""
    if angle_is_sound(recording):
        return unwrapped(recording.channels["phi_in"])
    return recording.point.omega_in * (recording.time - recording.time[0])


def order_2(recording: Recording) -> dict[str, Complex[np.ndarray, ""]]:
    """Order-2 line of the recorded gauges of s1 to s4 [mV/V]; empty for less than one revolution."""
    angle = angle_of(recording)
    gauges = [sensor for sensor in SENSORS[1:] if sensor in recording.channels]
    if not gauges or angle[-1] - angle[0] < 2 * np.pi * 0.99:
        return {}
    k = np.arange(1, FITTED_ORDERS + 1)[:, None]
    waves = np.concatenate([np.ones((1, len(angle))), np.cos(k * angle), np.sin(k * angle)])
    signals = np.array([recording.channels[sensor] for sensor in gauges])
    weights = np.linalg.lstsq(waves.T, signals.T, rcond=None)[0]
    return {sensor: np.asarray(w[2] - 1j * w[FITTED_ORDERS + 2]) for sensor, w in zip(gauges, weights.T, strict=True)}
