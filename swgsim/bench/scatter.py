"""How large the errors of a real test bench are, and draws of them for a data set (``condition=bench``).

The errors are those of imperfect units, jitter, temperature, noise and measured efficiency.

Every magnitude is a declared choice (conf/condition/bench.yaml) with its row in section 4 of physics.md.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from swgsim.chain.chain import Run
from swgsim.common.checks import require
from swgsim.effects import CamForm, EccentricWaveGenerator, Effect, OutputPosition, WarmGrease
from swgsim.gear.gear import Gear, OperatingPoint

# Lower and upper limit of each magnitude: beyond them the linear models of the chain do not hold.
LIMITS = {
    "eccentricity": (0, 50e-6),
    "cam_form": (0, 20e-6),
    "gauge_position": (0, 0.05),
    "load": (0, 0.05),
    "speed": (0, 0.02),
    "index_angle": (0, 0.1),
    "output_angle": (0, 6.2832),
    "temperature": (0, 15),
    "reference_temperature": (-40, 120),
    "temperature_error": (0, 20),
    "grease_exponent": (0, 0.1),
    "noise": (0, 0.1),
    "zero_drift": (0, 0.1),
    "flange_in": (0, 0.02),
    "flange_out": (0, 1),
    "flange_in_bias": (0, 0.02),
    "flange_out_bias": (0, 1),
    "speed_reading": (0, 0.01),
}


@dataclass(frozen=True)
class Session:
    """Bias of the torque flanges in all recordings of a session [N m]."""

    T_in: float
    T_out: float


@dataclass(frozen=True)
class Shaft:
    """Mean power [W] at the input, mean speeds [rad/s] and true efficiency of one run."""

    P_in: float
    omega_in: float
    omega_out: float
    efficiency: float


@dataclass(frozen=True)
class Bench:
    """Magnitudes of the errors of a test bench, and draws of them: standard deviations, unless otherwise given.

    The bench that also records folders of recordings is :mod:`swgsim.bench.virtual_bench`.

    Attributes
    ----------
    eccentricity : float
        Upper limit of the static eccentricity of a healthy unit, a uniform draw from 0 [m] (FS4).
    cam_form : float
        Upper limit of the lobing w_3 and w_5 of a unit's cam, uniform draws from 0 [m] (FS2).
    gauge_position : float
        Error of a unit's gauge positions in addition to those of its gear file [rad] (SE1).
    load, speed : float
        Relative error of load and speed against the set point (DY11).
    index_angle : float
        Jitter of the trigger [rad].
    output_angle : float
        Upper limit of the output angle at the trigger, a uniform draw from 0 [rad] (DY5).
    temperature : float
        Scatter of the gear's temperature about ``reference_temperature`` [K] (DY3).
    reference_temperature : float
        Temperature at which b1 holds [degC].
    temperature_error : float
        Error of the measured temperature [K].
    grease_exponent : float
        Exponent beta of the viscous friction [1/K] (DY3).
    noise : float
        White gauge noise [mV/V] (AC5).
    zero_drift : float
        Drift of each bridge's zero between recordings [mV/V] (SE5).
    flange_in, flange_out : float
        Error of the torque flanges that varies between recordings [N m] (DY14).
    flange_in_bias, flange_out_bias : float
        Their error that is constant in a session [N m]; a gear's references are one session, its samples another
        (DY14).
    speed_reading : float
        Relative error of the ratio of the measured speeds.

    Raises
    ------
    ValueError
        If a magnitude is beyond its limits.
    """

    eccentricity: float = 10e-6
    cam_form: float = 2e-6
    gauge_position: float = 0.0035
    load: float = 0.005
    speed: float = 0.001
    index_angle: float = 0.0035
    output_angle: float = 6.2832
    temperature: float = 4.0
    reference_temperature: float = 25.0
    temperature_error: float = 1.0
    grease_exponent: float = 0.025
    noise: float = 0.001
    zero_drift: float = 0.001
    flange_in: float = 0.001
    flange_out: float = 0.05
    flange_in_bias: float = 0.002
    flange_out_bias: float = 0.1
    speed_reading: float = 1e-4

    def __post_init__(self) -> None:
        for f in fields(self):
            low, high = LIMITS[f.name]
            require("the bench", f.name, getattr(self, f.name), low, high)

    def unit(self, gear: Gear, rng: np.random.Generator) -> tuple[Gear, tuple[Effect, ...]]:
        """One physical unit of a gear: its own gauge positions and its constant small imperfections."""
        position = np.array(gear.gauges.position) + rng.normal(0, self.gauge_position, 5)
        imperfections = (
            EccentricWaveGenerator(rng.uniform(0, self.eccentricity), rng.uniform(0, 2 * np.pi)),
            CamForm(3, rng.uniform(0, self.cam_form), rng.uniform(0, 2 * np.pi)),
            CamForm(5, rng.uniform(0, self.cam_form), rng.uniform(0, 2 * np.pi)),
        )
        return replace(gear, gauges=replace(gear.gauges, position=tuple(position))), imperfections

    def session(self, rng: np.random.Generator) -> Session:
        """One session of recordings."""
        return Session(rng.normal(0, self.flange_in_bias), rng.normal(0, self.flange_out_bias))

    def run(self, planned: Run, rng: np.random.Generator) -> tuple[Run, float]:
        """The actual run, and its measured temperature [degC]."""
        point = OperatingPoint(
            planned.point.n_in_rpm * (1 + self.speed * rng.standard_normal()),
            planned.point.T_out * (1 + self.load * rng.standard_normal()),
        )
        warmer = self.temperature * rng.standard_normal()
        whereabouts = OutputPosition(rng.uniform(0, self.output_angle))
        effects = (*planned.effects, WarmGrease(warmer, self.grease_exponent), whereabouts)
        conditions = replace(planned.conditions, temperature=self.reference_temperature + warmer)
        start = self.index_angle * rng.standard_normal()
        shown = self.reference_temperature + warmer + self.temperature_error * rng.standard_normal()
        return replace(planned, point=point, effects=effects, start_angle=start, conditions=conditions), shown

    def signals(
        self, ideal: Float[np.ndarray, "sensor time"], rng: np.random.Generator
    ) -> Float[np.ndarray, "sensor time"]:
        """The bridge signals with zero drift and noise [mV/V]."""
        drift = rng.normal(0, self.zero_drift, (len(ideal), 1))
        return ideal + drift + rng.normal(0, self.noise, ideal.shape)

    def efficiency(self, shaft: Shaft, session: Session, rng: np.random.Generator) -> float:
        """The efficiency from torque flanges and encoders."""
        P_in = shaft.P_in + (session.T_in + rng.normal(0, self.flange_in)) * shaft.omega_in
        P_out = shaft.P_in * shaft.efficiency
        P_out += (session.T_out + rng.normal(0, self.flange_out)) * shaft.omega_out
        return P_out / P_in * (1 + rng.normal(0, self.speed_reading))
