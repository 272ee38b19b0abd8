"""The effects that are tried where the textbook model of a joint falls short; waves are tried at orders found."""

from swgsim.joint.effects.asymmetric_friction import AsymmetricFriction
from swgsim.joint.effects.encoder_eccentricity import EncoderEccentricity
from swgsim.joint.effects.gravity_error import GravityError
from swgsim.joint.effects.inertia_error import InertiaError
from swgsim.joint.effects.load_curve import LoadCurve
from swgsim.joint.effects.load_dependent_friction import LoadDependentFriction
from swgsim.joint.effects.load_viscosity import LoadViscosity
from swgsim.joint.effects.maxwell_slip import MaxwellSlip
from swgsim.joint.effects.quadratic_friction import QuadraticFriction
from swgsim.joint.effects.stribeck_friction import StribeckFriction
from swgsim.joint.effects.sublinear_friction import SublinearFriction
from swgsim.joint.term import Term

SEARCHED: tuple[type[Term], ...] = (
    AsymmetricFriction,
    EncoderEccentricity,
    GravityError,
    InertiaError,
    LoadCurve,
    LoadDependentFriction,
    LoadViscosity,
    MaxwellSlip,
    QuadraticFriction,
    StribeckFriction,
    SublinearFriction,
)
