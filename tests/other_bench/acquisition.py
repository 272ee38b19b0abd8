"""What the bench writes of a motion: bridges and their amplifiers, torque flanges, encoder, tachometer.

Sizes of errors are estimates, of instruments of class 0.2 and of amplifiers of a test rig.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.signal import lfilter

from other_bench.circle import X
from other_bench.gauges import Maps, evaluated, signals
from other_bench.motion import RATE, Motion
from other_bench.schedule import Run
from other_bench.specimen import REFERENCE

# Gains and zeros of the flanges of T_in and T_out from session to session [-], [N m], and their noise [N m].
FLANGE_GAIN, FLANGE_ZERO, FLANGE_NOISE = np.array([2e-3, 2e-3]), np.array([1e-3, 0.03]), np.array([2e-3, 0.04])
# Zeros of the bridges from session to session and from recording to recording, drift in a quarter of an hour [mV/V].
ZERO, ZERO_OF_RUN, DRIFT, DRIFT_TIME = 0.004, 5e-5, 4e-4, 900.0
# Gain of the gauges with the temperature [1/K].
GAIN_PER_KELVIN = 1e-4
# White noise, and noise that forgets in 30 ms, over the rms of a healthy signal at 39 N m.
WHITE, SLOW, FORGETS, TYPICAL = 0.9e-3, 0.45e-3, 0.03, 39.0
# Steps of the converter [mV/V] and of the encoder [rad], noise of the tachometer [rpm].
CONVERTER, ENCODER, TACHOMETER = 3e-5, 2 * np.pi / 2**16, 0.5
MAINS = 50.0  # [Hz]


class Errors(NamedTuple):
    """Errors that all recordings of a session share.

    Attributes
    ----------
    zeros : array (gauge,)
        Of the bridges, beside the unit's own [mV/V].
    flange_gains, flange_zeros : array (2,)
        Of T_in and T_out [-], [N m].
    drift : array (gauge,)
        In DRIFT_TIME [mV/V].
    """

    zeros: Float[np.ndarray, " gauge"]
    flange_gains: Float[np.ndarray, " 2"]
    flange_zeros: Float[np.ndarray, " 2"]
    drift: Float[np.ndarray, " gauge"]

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> "Errors":
        """Those of one session."""
        zeros, gains = ZERO * rng.standard_normal(5), 1 + FLANGE_GAIN * rng.standard_normal(2)
        return cls(zeros, gains, FLANGE_ZERO * rng.standard_normal(2), DRIFT * rng.standard_normal(5))


def typical(maps: Maps) -> Float[np.ndarray, " gauge"]:
    """Rms of the signals over a revolution, which the noise is a share of [mV/V]."""
    return np.sqrt(np.mean(evaluated(maps.own, X, np.full(len(X), TYPICAL)) ** 2, axis=1))


def acquired(
    run: Run, motion: Motion, maps: Maps, errors: Errors, level: Float[np.ndarray, " gauge"], rng: np.random.Generator
) -> Float[np.ndarray, "time column"]:
    """Time, angle, speed, torques and s0 to s4 as they are written.

    Parameters
    ----------
    run : Run
    motion : Motion
    maps : Maps
        Of its unit.
    errors : Errors
    level : array (gauge,)
        See :func:`typical`.
    rng : Generator
    """
    t = np.arange(len(motion.phi)) / RATE
    s = _bridges(run, signals(run.unit, maps, motion), errors, rng)
    noise = WHITE * rng.standard_normal(s.shape) + SLOW * _slow(rng.standard_normal(s.shape))
    s = np.round((s + level[:, None] * noise) / CONVERTER) * CONVERTER
    first_turn = 2 * np.pi * np.floor(motion.phi[0] / (2 * np.pi))
    angle = np.round((motion.phi - first_turn + run.index) / ENCODER) * ENCODER
    n = motion.omega * 30 / np.pi + TACHOMETER * rng.standard_normal(len(t))
    torques = np.array([motion.T_in, motion.T_out]) * errors.flange_gains[:, None] + errors.flange_zeros[:, None]
    torques += FLANGE_NOISE[:, None] * rng.standard_normal(torques.shape)
    return np.column_stack([t, angle, n, torques.T, s.T])


def _bridges(
    run: Run, s: Float[np.ndarray, "gauge time"], errors: Errors, rng: np.random.Generator
) -> Float[np.ndarray, "gauge time"]:
    """Signals with the errors of gauges and amplifiers, but for noise."""
    unit, warmer = run.unit, run.temperature - REFERENCE
    t = np.arange(s.shape[1]) / RATE
    s = s * (unit.gain * (1 + GAIN_PER_KELVIN * warmer))[:, None]
    zeros = unit.offset + errors.zeros + errors.drift * run.elapsed / DRIFT_TIME
    zeros += ZERO_OF_RUN * rng.standard_normal(5)
    s += zeros[:, None]
    if unit.hum.any():
        s += unit.hum[:, None] * np.sin(2 * np.pi * MAINS * t + rng.uniform(0, 2 * np.pi))
    return s


def _slow(white: Float[np.ndarray, "gauge time"]) -> Float[np.ndarray, "gauge time"]:
    """Noise of unit variance that forgets: an autoregression."""
    kept = np.exp(-1 / (FORGETS * RATE))
    return lfilter([np.sqrt(1 - kept**2)], [1, -kept], white, axis=-1)
