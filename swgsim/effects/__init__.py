"""Physical effects that change the chain at a known place, one file each; the five faults of Table I are among them.

Imports ``gear`` and rooms below it. :data:`LIBRARY` lists them by their names in files, such as ``root_tooth_crack``.
"""

from swgsim.effects.aged_grease import AgedGrease
from swgsim.effects.amplifier_drift import AmplifierDrift
from swgsim.effects.axial_thrust import AxialThrust
from swgsim.effects.ball_pass import BallPass
from swgsim.effects.base import Crack, Effect
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
from swgsim.effects.library import LIBRARY, SEARCHED, named
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

__all__ = [
    "LIBRARY",
    "SEARCHED",
    "AgedGrease",
    "AmplifierDrift",
    "AxialThrust",
    "BallPass",
    "BearingCage",
    "BearingFriction",
    "BoltPreload",
    "BondCreep",
    "BridgeNonlinearity",
    "CamForm",
    "ChannelCrosstalk",
    "ChannelSkew",
    "ChurningLoss",
    "CircularSplineRunout",
    "Clipping",
    "Coning",
    "Crack",
    "CubicFriction",
    "Debonding",
    "EccentricWaveGenerator",
    "Effect",
    "ElasticHysteresis",
    "EncoderEccentricity",
    "FilterMismatch",
    "FixedFrequency",
    "FlangeGain",
    "FlangeZero",
    "FlankFriction",
    "FractionalOrder",
    "GaugeDirection",
    "GaugeFactorTemperature",
    "GaugeGain",
    "GaugePosition",
    "GreaseSettling",
    "GreaseTemperature",
    "InputFriction",
    "InputUnbalance",
    "KinematicErrorOrder",
    "LoadDependentFriction",
    "LoadSharing",
    "LoadTorqueRipple",
    "LobeShift",
    "LostMotion",
    "MainsHum",
    "MeshShift",
    "MotorPickup",
    "MotorTorqueRipple",
    "OutOfRound",
    "OutputPosition",
    "ParameterScatter",
    "PositionFriction",
    "ReducedDamping",
    "ReducedStiffness",
    "Regularity",
    "RootToothCrack",
    "RotatingEccentricity",
    "RunIn",
    "SealFriction",
    "SelfHeating",
    "SignalHysteresis",
    "SpeedDeformation",
    "SpeedRipple",
    "StiffeningSpring",
    "StiffnessRipple",
    "StribeckFriction",
    "SubOrders",
    "ThermalGrowth",
    "ThermalOutput",
    "TiltedWaveGenerator",
    "TiltingMoment",
    "TipToothCrack",
    "TorqueNonlinearity",
    "UnevenSleeve",
    "UnevenTeeth",
    "WarmGrease",
    "WornWaveGenerator",
    "ZeroOffset",
    "named",
]
