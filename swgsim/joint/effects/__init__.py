"""Effects that the textbook model of a joint lacks. Waves are candidates at the orders that the residual shows."""

from swgsim.joint.effects.friction import (
    AsymmetricFriction,
    LoadViscosity,
    QuadraticFriction,
    StribeckFriction,
    SublinearFriction,
)
from swgsim.joint.effects.load import EncoderEccentricity, GravityError, InertiaError, LoadCurve
from swgsim.joint.effects.slip import LoadDependentFriction, MaxwellSlip
from swgsim.joint.term import Term

#: Effects that every search tests, besides waves.
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
