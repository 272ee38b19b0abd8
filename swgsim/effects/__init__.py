"""Physical effects that change the chain at a known place; the five faults of the paper are effects with a label."""

from swgsim.effects.base import Crack, Effect
from swgsim.effects.cam_form import CamForm
from swgsim.effects.eccentric_wave_generator import EccentricWaveGenerator
from swgsim.effects.output_position import OutputPosition
from swgsim.effects.parameter_scatter import ParameterScatter
from swgsim.effects.reduced_damping import ReducedDamping
from swgsim.effects.reduced_stiffness import ReducedStiffness
from swgsim.effects.root_tooth_crack import RootToothCrack
from swgsim.effects.run_in import RunIn
from swgsim.effects.tip_tooth_crack import TipToothCrack
from swgsim.effects.warm_grease import WarmGrease

__all__ = [
    "CamForm",
    "Crack",
    "EccentricWaveGenerator",
    "Effect",
    "OutputPosition",
    "ParameterScatter",
    "ReducedDamping",
    "ReducedStiffness",
    "RootToothCrack",
    "RunIn",
    "TipToothCrack",
    "WarmGrease",
]
