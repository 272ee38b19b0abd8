"""What a real test bench adds to the ideal chain: imperfect units, jitter, temperature, noise and measured efficiency.

Every magnitude is a declared choice (conf/condition/bench.yaml) with its row in section 4 of physics.md.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from swgsim.chain import Run
from swgsim.checks import require
from swgsim.effects import CamForm, EccentricWaveGenerator, Effect, WarmGrease
from swgsim.gear import Gear, OperatingPoint


@dataclass(frozen=True)
class Bench:
    """Magnitudes of the bench; standard deviations unless said otherwise.

    Attributes
    ----------
    eccentricity : float
        Largest static eccentricity of a healthy unit, drawn evenly from 0 [m] (FS4).
    cam_form : float
        Largest lobing w_3 and w_5 of a unit's cam, drawn evenly from 0 [m] (FS2).
    gauge_position : float
        Error of a unit's gauge positions beyond those of its gear file [rad] (SE1).
    load, speed : float
        Relative error of load and speed against the set point (DY11).
    index_angle : float
        Jitter of the trigger [rad].
    temperature : float
        Of the gear about ``reference_temperature`` [K] (DY3).
    reference_temperature : float
        At which b1 holds [degC].
    temperature_error : float
        Of its measurement [K].
    grease_exponent : float
        beta of the viscous friction [1/K] (DY3).
    noise : float
        White gauge noise [mV/V] (AC5).
    zero_drift : float
        Drift of each bridge's zero between recordings [mV/V] (SE5).
    flange_in, flange_out : float
        Error of the torque flanges [N m]; 0.1 % of a 2 N m and a 100 N m flange (DY14).
    """

    eccentricity: float = 10e-6
    cam_form: float = 2e-6
    gauge_position: float = 0.0035
    load: float = 0.005
    speed: float = 0.001
    index_angle: float = 0.0035
    temperature: float = 4.0
    reference_temperature: float = 25.0
    temperature_error: float = 1.0
    grease_exponent: float = 0.025
    noise: float = 0.001
    zero_drift: float = 0.001
    flange_in: float = 0.002
    flange_out: float = 0.1

    def __post_init__(self) -> None:
        for f in fields(self):
            if f.name != "reference_temperature":
                require("the bench", f.name, getattr(self, f.name), low=0, high=20)

    def unit(self, gear: Gear, rng: np.random.Generator) -> tuple[Gear, tuple[Effect, ...]]:
        """One physical unit of a gear: its own gauge positions and the small imperfections that stay with it."""
        position = np.array(gear.gauges.position) + rng.normal(0, self.gauge_position, 5)
        imperfections = (
            EccentricWaveGenerator(rng.uniform(0, self.eccentricity), rng.uniform(0, 2 * np.pi)),
            CamForm(3, rng.uniform(0, self.cam_form), rng.uniform(0, 2 * np.pi)),
            CamForm(5, rng.uniform(0, self.cam_form), rng.uniform(0, 2 * np.pi)),
        )
        return replace(gear, gauges=replace(gear.gauges, position=tuple(position))), imperfections

    def run(self, planned: Run, rng: np.random.Generator) -> tuple[Run, float]:
        """The run as it really takes place, and the temperature as its sensor shows it [degC]."""
        point = OperatingPoint(
            planned.point.n_in_rpm * (1 + self.speed * rng.standard_normal()),
            planned.point.T_out * (1 + self.load * rng.standard_normal()),
        )
        warmer = self.temperature * rng.standard_normal()
        effects = (*planned.effects, WarmGrease(warmer, self.grease_exponent))
        start = self.index_angle * rng.standard_normal()
        shown = self.reference_temperature + warmer + self.temperature_error * rng.standard_normal()
        return replace(planned, point=point, effects=effects, start_angle=start), shown

    def signals(
        self, ideal: Float[np.ndarray, "sensor time"], rng: np.random.Generator
    ) -> Float[np.ndarray, "sensor time"]:
        """The bridge signals with zero drift and noise [mV/V]."""
        drift = rng.normal(0, self.zero_drift, (len(ideal), 1))
        return ideal + drift + rng.normal(0, self.noise, ideal.shape)

    def efficiency(self, true: float, T_in: float, T_out: float, rng: np.random.Generator) -> float:
        """The efficiency as the torque flanges show it."""
        return true * (1 + rng.normal(0, self.flange_out) / T_out) / (1 + rng.normal(0, self.flange_in) / T_in)
