"""The structure: lattice and truss of the flex spline, its cyclic symmetry, and the strain gauges bonded to it."""

from swgsim.flexspline.flexspline import FlexSpline, gauge_response, solve_flex_spline
from swgsim.flexspline.gauges import GaugeSet, bridges, strain_rows, waves
from swgsim.flexspline.silk_hat import SilkHat
from swgsim.flexspline.truss import Truss

__all__ = [
    "FlexSpline",
    "GaugeSet",
    "SilkHat",
    "Truss",
    "bridges",
    "gauge_response",
    "solve_flex_spline",
    "strain_rows",
    "waves",
]
