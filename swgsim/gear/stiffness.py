"""Torsional stiffness as a test bench measures it: output torque over twist, with the input locked."""

from math import tan

from scipy.optimize import brentq

from swgsim.common.checks import require_positive
from swgsim.gear.gear import Transmission

# Rated torque of a size 17, ratio 100 gear (catalogue) [N m].
RATED_TORQUE = 31.0


def static_torque(transmission: Transmission, twist: float) -> float:
    """Output torque [N m] that holds a twist of the output [rad]: eqs. (2) and (3) with phi_in = 0, no friction."""
    flank = twist / tan(transmission.alpha_tooth)
    T_stiff = (transmission.k1 + transmission.k2 * flank**2) * flank
    return T_stiff / tan(transmission.alpha_tooth)


def torsional_stiffness(transmission: Transmission, T_out: float = RATED_TORQUE) -> float:
    """Secant stiffness of the output from no torque to ``T_out`` [N m/rad].

    Parameters
    ----------
    transmission : Transmission
    T_out : float
        Torque at which the twist is read [N m], above 0.
    """
    require_positive("the stiffness measurement", T_out=T_out)
    largest = T_out * tan(transmission.alpha_tooth) ** 2 / transmission.k1
    return T_out / float(brentq(lambda twist: static_torque(transmission, twist) - T_out, 0, 1.01 * largest))
