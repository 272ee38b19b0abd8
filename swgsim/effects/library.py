"""The library of effects by their registered names: all classes that are imported here."""

# ruff: noqa: F401

import importlib
import sys
from collections.abc import Mapping, Sequence

from swgsim.common.checks import nearest
from swgsim.effects.aged_grease import AgedGrease
from swgsim.effects.amplifier_drift import AmplifierDrift
from swgsim.effects.axial_thrust import AxialThrust
from swgsim.effects.ball_pass import BallPass
from swgsim.effects.base import PLACES, Effect
from swgsim.effects.bearing_cage import BearingCage
from swgsim.effects.bearing_friction import BearingFriction
from swgsim.effects.bolt_preload import BoltPreload
from swgsim.effects.bond_creep import BondCreep
from swgsim.effects.bridge_nonlinearity import BridgeNonlinearity
from swgsim.effects.cam_form import CamForm
from swgsim.effects.channel_crosstalk import ChannelCrosstalk
from swgsim.effects.channel_skew import ChannelSkew
from swgsim.effects.churning_loss import ChurningLoss
from swgsim.effects.circular_spline_runout import CircularSplineRunout
from swgsim.effects.clipping import Clipping
from swgsim.effects.coning import Coning
from swgsim.effects.cubic_friction import CubicFriction
from swgsim.effects.debonding import Debonding
from swgsim.effects.eccentric_wave_generator import EccentricWaveGenerator
from swgsim.effects.elastic_hysteresis import ElasticHysteresis
from swgsim.effects.encoder_eccentricity import EncoderEccentricity
from swgsim.effects.filter_mismatch import FilterMismatch
from swgsim.effects.flange_gain import FlangeGain
from swgsim.effects.flange_zero import FlangeZero
from swgsim.effects.flank_friction import FlankFriction
from swgsim.effects.gauge_direction import GaugeDirection
from swgsim.effects.gauge_factor_temperature import GaugeFactorTemperature
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.gauge_position import GaugePosition
from swgsim.effects.grease_settling import GreaseSettling
from swgsim.effects.grease_temperature import GreaseTemperature
from swgsim.effects.input_friction import InputFriction
from swgsim.effects.input_unbalance import InputUnbalance
from swgsim.effects.kinematic_error_order import KinematicErrorOrder
from swgsim.effects.line_between import FixedFrequency, FractionalOrder
from swgsim.effects.load_dependent_friction import LoadDependentFriction
from swgsim.effects.load_sharing import LoadSharing
from swgsim.effects.load_torque_ripple import LoadTorqueRipple
from swgsim.effects.lobe_shift import LobeShift
from swgsim.effects.lost_motion import LostMotion
from swgsim.effects.mains_hum import MainsHum
from swgsim.effects.mesh_shift import MeshShift
from swgsim.effects.motor_pickup import MotorPickup
from swgsim.effects.motor_torque_ripple import MotorTorqueRipple
from swgsim.effects.out_of_round import OutOfRound
from swgsim.effects.output_position import OutputPosition
from swgsim.effects.parameter_scatter import ParameterScatter
from swgsim.effects.position_friction import PositionFriction
from swgsim.effects.reduced_damping import ReducedDamping
from swgsim.effects.reduced_stiffness import ReducedStiffness
from swgsim.effects.regularity import Regularity
from swgsim.effects.root_tooth_crack import RootToothCrack
from swgsim.effects.rotating_eccentricity import RotatingEccentricity
from swgsim.effects.run_in import RunIn
from swgsim.effects.seal_friction import SealFriction
from swgsim.effects.self_heating import SelfHeating
from swgsim.effects.signal_hysteresis import SignalHysteresis
from swgsim.effects.speed_deformation import SpeedDeformation
from swgsim.effects.speed_ripple import SpeedRipple
from swgsim.effects.stiffening_spring import StiffeningSpring
from swgsim.effects.stiffness_ripple import StiffnessRipple
from swgsim.effects.stribeck_friction import StribeckFriction
from swgsim.effects.sub_orders import SubOrders
from swgsim.effects.thermal_growth import ThermalGrowth
from swgsim.effects.thermal_output import ThermalOutput
from swgsim.effects.tilted_wave_generator import TiltedWaveGenerator
from swgsim.effects.tilting_moment import TiltingMoment
from swgsim.effects.tip_tooth_crack import TipToothCrack
from swgsim.effects.torque_nonlinearity import TorqueNonlinearity
from swgsim.effects.uneven_sleeve import UnevenSleeve
from swgsim.effects.uneven_teeth import UnevenTeeth
from swgsim.effects.warm_grease import WarmGrease
from swgsim.effects.worn_wave_generator import WornWaveGenerator
from swgsim.effects.zero_offset import ZeroOffset

# Effects that vary between recordings, stand for several others, or have no known cause.
OTHERS: tuple[type[Effect], ...] = (
    FixedFrequency,
    FractionalOrder,
    OutputPosition,
    ParameterScatter,
    Regularity,
    RunIn,
)
# Effects that the identification searches, by place and name: all others.
SEARCHED: tuple[type[Effect], ...] = tuple(
    sorted(
        (
            kind
            for kind in vars().values()
            if isinstance(kind, type) and issubclass(kind, Effect) and kind is not Effect and kind not in OTHERS
        ),
        key=lambda kind: (PLACES.index(kind.place), kind.__name__),
    )
)
LIBRARY: Mapping[str, type[Effect]] = {kind.name(): kind for kind in (*SEARCHED, *OTHERS)}


def listed(names: str | Sequence[str] | None) -> list[str]:
    """Names from a list, from one text with commas between them, or none.

    >>> listed("cam_form, coning")
    ['cam_form', 'coning']
    """
    return [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names or ())


def named(name: str) -> type[Effect]:
    """An effect of the library by its name, or any other one by its import path ``module:Class``.

    Raises
    ------
    ValueError
        If there is no such effect; the message names similar ones.
    """
    if name in LIBRARY:
        return LIBRARY[name]
    module, _, kind = name.partition(":")
    if not all(part.isidentifier() for part in (*module.split("."), kind)):
        near = nearest(name, LIBRARY)
        question = f" Did you mean {' or '.join(near)}?" if near else ""
        raise ValueError(
            f"unknown effect {name!r}.{question} The library has {len(LIBRARY)}: swg effects lists them; an effect of "
            "your own needs its import path module:Class"
        )
    if module.partition(".")[0] in sys.stdlib_module_names:
        # Not imported, because some modules of Python act when they are imported.
        raise ValueError(f"{name!r} is no effect: it must be a class derived from {Effect.__module__}.Effect")
    try:
        found = getattr(importlib.import_module(module), kind)
    except (ImportError, AttributeError) as error:
        raise ValueError(
            f"effect {name!r} cannot be imported: {error}; is the folder of {module} on PYTHONPATH?"
        ) from error
    if not (isinstance(found, type) and issubclass(found, Effect)):
        raise ValueError(f"{name!r} is no effect: it must be a class derived from swgsim.effects.base.Effect")
    return found
