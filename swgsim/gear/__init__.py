"""A gear and how it runs: parameters (Table II), operating point, conditions, sampling window."""

from swgsim.gear.acquisition import Window
from swgsim.gear.conditions import REFERENCE_TEMPERATURE, Conditions
from swgsim.gear.gear import Gear, KinematicError, OperatingPoint, Transmission, WaveGenerator, gear_from
from swgsim.gear.population import Population
from swgsim.gear.stiffness import RATED_TORQUE, torsional_stiffness

__all__ = [
    "RATED_TORQUE",
    "REFERENCE_TEMPERATURE",
    "Conditions",
    "Gear",
    "KinematicError",
    "OperatingPoint",
    "Population",
    "Transmission",
    "WaveGenerator",
    "Window",
    "gear_from",
    "torsional_stiffness",
]
