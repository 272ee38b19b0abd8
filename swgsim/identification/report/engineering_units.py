"""Parameters of effects as engineers write them: a name in words, and a unit such as µm or %.

Everything inside the package is in SI units; only texts, tables and pages use this module.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from swgsim.common.numbers import significant
from swgsim.effects.one_gauge import ALL

Estimate = Mapping[str, Any]  # "value", "ci95" and "unit" of report.json


@dataclass(frozen=True)
class Scale:
    """An engineering unit: ``factor`` times the value in SI units."""

    factor: float
    unit: str


PLAIN, PERCENT = Scale(1.0, ""), Scale(100.0, "%")
MICROMETRE, MILLIMETRE = Scale(1e6, "µm"), Scale(1e3, "mm")
DEGREE, ARCMIN = Scale(180 / np.pi, "°"), Scale(60 * 180 / np.pi, "arcmin")
MICROSECOND = Scale(1e6, "µs")
PER_REVOLUTION = Scale(1.0, "per revolution")

# Engineering unit of each SI unit, if neither the parameter nor the effect has another one.
SCALES = {
    "m": MICROMETRE,
    "rad": DEGREE,
    "-": PLAIN,
    "K": Scale(1.0, "°C"),
    "1/K": Scale(100.0, "%/°C"),
    "1/h": Scale(100.0, "%/h"),
    "1/(mV/V)": Scale(100.0, "% per mV/V"),
    "mV/V per K": Scale(1.0, "mV/V per °C"),
}
# Name, and the engineering unit if the one above does not fit, of a parameter of any effect.
PARAMETERS: Mapping[str, tuple[str, Scale | None]] = {
    "sensor": ("gauge", None),
    "amplitude": ("amplitude", None),
    "phase": ("phase", None),
    "theta": ("direction from gauge s1, in the sense of rotation", None),
    "order": ("order", PER_REVOLUTION),
    "share": ("relative change", PERCENT),
    "time_constant": ("time constant", None),
    "power": ("power", None),
    "n": ("waves around the circumference", None),
    "k": ("waves around the circumference", None),
    "e": ("relative amplitude", PERCENT),
    "T": ("torque at the input", None),
    "rate": ("drift", None),
    "slope": ("change with temperature", None),
    "strain": ("signal", None),
    "unequal": ("unequal load of the two lobes (0 equal, 1 in proportion to depth)", None),
    "waves": ("number of balls modulo 4", None),
    "preload": ("share that does not depend on the load", PERCENT),
}
# The same where it differs from effect to effect.
OF_EFFECT: Mapping[str, tuple[str, Scale | None]] = {
    "aged_grease.share": ("rise of the flank friction coefficient", PERCENT),
    "cubic_friction.b2": ("additional cubic friction b2", None),
    "flank_friction.mu_ratio": ("flank friction coefficient relative to the nominal one", PERCENT),
    "gauge_direction.angle": ("rotation of the grids", None),
    "gauge_gain.share": ("change of the gain", PERCENT),
    "gauge_position.shift": ("shift along the collar", None),
    "grease_settling.share": ("additional viscous friction at the start", PERCENT),
    "grease_temperature.beta": ("fall of the viscous friction with temperature", None),
    "kinematic_error_order.amplitude": ("amplitude at the output", ARCMIN),
    "load_dependent_friction.c": ("rise of the flank friction coefficient per rated torque", PERCENT),
    "reduced_damping.b1_ratio": ("damping b1 relative to the healthy one", PERCENT),
    "reduced_stiffness.k1_ratio": ("stiffness k1 relative to the healthy one", PERCENT),
    "stiffening_spring.share": ("change of the cubic stiffness k2", PERCENT),
    "warm_grease.dT": ("warmer than the reference", None),
    "warm_grease.beta": ("fall of the viscous friction with temperature", None),
    "zero_offset.offset": ("zero offset", None),
    "bearing_friction.T": ("torque at the input at rated load", None),
    "churning_loss.T": ("torque at the input at 2000 rpm", None),
    "elastic_hysteresis.h": ("loss factor", PERCENT),
    "load_torque_ripple.share": ("amplitude relative to the load", PERCENT),
    "lost_motion.half_gap": ("half of the gap at the output", ARCMIN),
    "speed_ripple.share": ("amplitude relative to the speed", PERCENT),
    "stiffness_ripple.share": ("amplitude relative to the stiffness", PERCENT),
    "stribeck_friction.b_s": ("additional friction at standstill", None),
    "stribeck_friction.v_s": ("sliding speed at which 37 % of it remain", None),
    "coning.share": ("change of the deflection at 70 N m", PERCENT),
    "eccentric_wave_generator.r": ("eccentricity", None),
    "lobe_shift.angle": ("rotation of the lobes at 70 N m", None),
    "out_of_round.n": ("number of lobes", None),
    "rotating_eccentricity.e": ("eccentricity", MICROMETRE),
    "rotating_eccentricity.phase": ("direction, ahead of the major axis", None),
    "cam_form.n": ("number of lobes", None),
    "speed_deformation.share": ("change of the deflection at 4000 rpm", PERCENT),
    "thermal_growth.share": ("growth of the deflection with temperature", None),
    "tilted_wave_generator.tilt": ("tilt", None),
    "tilted_wave_generator.lever": ("distance from the pivot to the band", MILLIMETRE),
    "uneven_sleeve.e": ("relative variation of the wall thickness", PERCENT),
    "worn_wave_generator.loss": ("loss of deflection", PERCENT),
    "load_sharing.change": ("change of the exponent of load sharing at 70 N m", None),
    "mesh_shift.angle": ("shift of the tooth force along the circumference", None),
    "tip_tooth_crack.force_loss": ("loss of tooth force", PERCENT),
    "tip_tooth_crack.theta": ("position from gauge s1, in the sense of rotation", None),
    "tip_tooth_crack.width": ("width of the affected teeth", None),
    "tip_tooth_crack.taken_over": ("force taken over by other teeth (1 yes, 0 no)", None),
    "root_tooth_crack.stiffness_ratio": ("remaining stiffness of one tooth pitch", PERCENT),
    "root_tooth_crack.theta": ("position from gauge s1, in the sense of rotation", None),
    "axial_thrust.strain": ("signal at 70 N m", None),
    "axial_thrust.on_s0": ("also on gauge s0 (1 yes, 0 no)", None),
    "bolt_preload.strain": ("signal of s1 and s3", None),
    "bond_creep.share": ("creep of the signal", PERCENT),
    "bridge_nonlinearity.share": ("nonlinearity", None),
    "debonding.rate": ("loss of signal", None),
    "self_heating.drift": ("drift of the zeros", None),
    "signal_hysteresis.share": ("width of the loop relative to the range", PERCENT),
    "tilting_moment.with_load": ("in proportion to the load (1 yes, 0 no)", None),
    "torque_nonlinearity.share": ("nonlinearity at 70 N m", PERCENT),
    "channel_crosstalk.share": ("share of the next channel", PERCENT),
    "channel_skew.delay": ("delay from channel to channel", MICROSECOND),
    "clipping.level": ("largest signal", None),
    "encoder_eccentricity.error": ("error of the angle", None),
    "encoder_eccentricity.tells_speed": ("also in the speed (1 yes, 0 no)", None),
    "filter_mismatch.lag": ("lag", MICROSECOND),
    "flange_gain.share": ("error of the gain", PERCENT),
    "flange_gain.at_input": ("flange (1 input, 0 output)", None),
    "flange_zero.zero": ("zero offset of the input torque", None),
    "mains_hum.frequency": ("frequency", None),
    "mains_hum.deviation": ("deviation of the mains frequency", PERCENT),
    "motor_pickup.p": ("pole pairs", None),
    "sub_orders.j": ("revolutions per cycle", None),
}


def parameter_words(effect: str, parameter: str) -> str:
    """The name of a parameter in words.

    >>> parameter_words("eccentric_wave_generator", "r"), parameter_words("outside:Effect", "dry_gap")
    ('eccentricity', 'dry gap')
    """
    words, _ = OF_EFFECT.get(f"{effect}.{parameter}") or PARAMETERS.get(parameter, ("", None))
    return words or parameter.replace("_", " ")


def scale(effect: str, parameter: str, unit: str) -> Scale:
    """The engineering unit of a parameter whose SI unit is given.

    >>> scale("eccentric_wave_generator", "r", "m").unit, scale("outside:Effect", "dry_gap", "N s").unit
    ('µm', 'N s')
    """
    _, own = OF_EFFECT.get(f"{effect}.{parameter}") or PARAMETERS.get(parameter, ("", None))
    # A parameter of an effect from outside may share the name of one of the library, but not its unit.
    if own is not None and (unit == "-") == (own in (PLAIN, PERCENT, PER_REVOLUTION)):
        return own
    return SCALES.get(unit, Scale(1.0, unit))


def in_unit(effect: str, parameter: str, estimate: Estimate) -> tuple[float | None, list[float] | None, str]:
    """Value, 95 % interval and engineering unit of a parameter.

    Parameters
    ----------
    effect : str
        Registered name.
    parameter : str
    estimate : mapping
        ``value``, ``ci95`` (two numbers or None) and ``unit`` as in ``report.json``.
    """
    to = scale(effect, parameter, estimate["unit"])
    value, interval = estimate["value"], estimate.get("ci95")
    return (
        None if value is None else to.factor * value,
        None if interval is None else [to.factor * end for end in interval],
        to.unit,
    )


def value_text(effect: str, parameter: str, estimate: Estimate) -> str:
    """A value with its engineering unit; gauges by their names.

    >>> value_text("eccentric_wave_generator", "r", {"value": 1.0125e-5, "ci95": [9.75e-6, 1.05e-5], "unit": "m"})
    '10.1 µm'
    >>> value_text("gauge_gain", "sensor", {"value": 5.0, "ci95": None, "unit": "-"})
    'all gauges'
    """
    value, _, unit = in_unit(effect, parameter, estimate)
    if parameter == "sensor" and value is not None:
        return "all gauges" if value == ALL else f"s{value:.0f}"
    return _with(significant(value) if unit != "°" or value is None or abs(value) < 10 else f"{value:.0f}", unit)


def interval_text(effect: str, parameter: str, estimate: Estimate) -> str:
    """The 95 % interval with as many decimals as the value; empty if there is none.

    >>> interval_text("eccentric_wave_generator", "r", {"value": 1.0125e-5, "ci95": [9.75e-6, 1.05e-5], "unit": "m"})
    '9.8 to 10.5'
    """
    value, interval, _ = in_unit(effect, parameter, estimate)
    if interval is None or value is None:
        return ""
    shown = value_text(effect, parameter, estimate).split()[0].rstrip("°")
    decimals = len(shown.partition(".")[2]) if "e" not in shown else None
    if decimals is None or f"{interval[0]:.{decimals}f}" == f"{interval[1]:.{decimals}f}":
        return f"{significant(interval[0])} to {significant(interval[1])}"
    low, high = (f"{end + 0.0:.{decimals}f}" for end in interval)
    return f"{low} to {high}"


def _with(value: str, unit: str) -> str:
    return value + ("" if not unit else unit if unit == "°" else f" {unit}")
