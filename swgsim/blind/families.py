"""Families of doubles: effects that recordings at steady operating points hardly separate."""

from collections.abc import Mapping

FAMILIES: Mapping[str, tuple[str, ...]] = {
    "viscous friction": ("reduced_damping", "warm_grease"),
    "friction of the flanks": ("flank_friction", "aged_grease", "load_dependent_friction"),
    "place of one bridge": ("gauge_position", "gauge_direction"),
    "torque at the input": ("seal_friction", "flange_zero", "churning_loss", "bearing_friction"),
    "ripple of the input": ("input_friction", "input_unbalance", "motor_torque_ripple", "speed_ripple"),
    "deflection": ("worn_wave_generator", "speed_deformation", "thermal_growth"),
    "gain over time": ("amplifier_drift", "bond_creep"),
    "delay of channels": ("channel_skew", "filter_mismatch"),
    "pick-up in all bridges": ("motor_pickup", "mains_hum"),
}


def family(name: str) -> str:
    """The family of an effect, its own name if it has none.

    >>> family("warm_grease"), family("cam_form")
    ('viscous friction', 'cam_form')
    """
    return next((label for label, members in FAMILIES.items() if name in members), name)
