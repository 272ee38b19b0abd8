"""The flex spline as a linear structure: response to wave generator, teeth and cracks, per circumferential order.

Fields are discrete Fourier amplitudes over the sectors. A load exp(i n theta) around the circumference gives a
displacement of the same form, so one solve per order n gives the response to a load on any sector.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import tan

import numpy as np
from jaxtyping import Bool, Complex, Float, Int

from swgsim.flexspline import cyclic
from swgsim.flexspline.gauges import GaugeSet, bridges, strain_rows
from swgsim.flexspline.lattice import INNER, OUTER
from swgsim.flexspline.silk_hat import Sector, SilkHat, sector
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, StructureFactors

WAVE_GENERATOR, TEETH, BAND = 0, 1, 2


@dataclass(frozen=True, eq=False)
class FlexSpline:
    """Solved flex spline.

    Attributes
    ----------
    sector : Sector
    fields : array (order, dof, load)
        Displacements for load 0, unit radial displacement of the wave generator [m/m]; load 1, unit tangential tooth
        force with its radial part [m/N]; loads 2 and on, a unit force on each degree of freedom of the toothed band,
        where cracks act [m/N].
    """

    sector: Sector
    fields: Complex[np.ndarray, "order dof load"]

    @property
    def band(self) -> Int[np.ndarray, " band"]:
        """Degrees of freedom of the toothed band of one sector."""
        return np.flatnonzero(np.repeat(self.sector.band, 3))

    @property
    def tooth_radius(self) -> float:
        """Radius at which the tooth forces act [m]."""
        return self.sector.hat.radius + self.sector.hat.wall / 2

    @cached_property
    def crossing_stiffness(self) -> Float[np.ndarray, "twoband twoband"]:
        """Stiffness [N/m] of the bars that cross from a sector's toothed band to the next one's.

        Rows and columns: the band's degrees of freedom in the sector, then in the next.
        """
        bars = self.sector.bars
        crossing = np.flatnonzero(self.sector.band[bars[:, 0]] & self.sector.band[bars[:, 1]] & (bars[:, 2] == 1))
        dof = 3 * len(self.sector.nodes)
        rows = np.zeros((len(crossing), 2 * dof))
        index = np.arange(len(crossing))[:, None]
        here, following = cyclic.bar_axes(self.sector)
        rows[index, 3 * bars[crossing, :1] + np.arange(3)] = -here[crossing]
        rows[index, dof + 3 * bars[crossing, 1:2] + np.arange(3)] = following[crossing]
        rows = rows[:, np.concatenate([self.band, dof + self.band])]
        return rows.T @ (self.sector.stiffness[crossing, None] * rows)

    @cached_property
    def band_compliance(self) -> Float[np.ndarray, "sector band band"]:
        """Displacement [m/N] of a band's degrees of freedom under unit forces on a band some sectors before."""
        return np.fft.irfft(self.fields[:, self.band, BAND:], self.sector.count, axis=0)

    @cached_property
    def compliance(self) -> Complex[np.ndarray, "order 2"]:
        """Radial displacement of the band per unit radial force on each sector [m/N], and per unit tooth force.

        The band is displaced evenly over its width, as the wave generator imposes it, and the force is what that needs.
        """
        own, ahead = cyclic.stiffness_blocks(self.sector)
        inside = np.flatnonzero(np.repeat(self.sector.band & self.sector.layer(INNER), 3))[0::3]
        phase = np.exp(1j * self.sector.pitch * cyclic.orders(self.sector.count))[:, None]
        fields = self.fields[:, :, [WAVE_GENERATOR, TEETH]]
        of_own, of_next, of_last = (block[inside].sum(axis=0) @ fields for block in (own, ahead, ahead.T))
        force = of_own + phase * of_next + np.conj(phase) * of_last
        return np.stack([1 / force[:, WAVE_GENERATOR], -force[:, TEETH] / force[:, WAVE_GENERATOR]], axis=1)

    def displacement(
        self, amplitudes: Complex[np.ndarray, "order load"], weights: Float[np.ndarray, " order"]
    ) -> Float[np.ndarray, "sector node 3"]:
        """Nodal displacements (radial, circumferential, axial) [m] of all sectors under given load amplitudes."""
        per_order = weights[:, None] * np.einsum("ndl,nl->nd", self.fields[:, :, : amplitudes.shape[1]], amplitudes)
        n, k = cyclic.orders(self.sector.count), np.arange(self.sector.count)
        around = np.exp(1j * self.sector.pitch * np.outer(k, n))
        return (around @ per_order).real.reshape(self.sector.count, -1, 3)


def gauge_response(
    flex: FlexSpline, gauges: GaugeSet, factors: StructureFactors = EXACT_STRUCTURE
) -> Complex[np.ndarray, "order 5 load"]:
    """Bridge signals per load and circumferential order [mV/V per m, per N]."""
    response = _gauge_response(flex, gauges)
    return response if factors == EXACT_STRUCTURE else factors.applied(response)


@lru_cache(maxsize=64)
def _gauge_response(flex: FlexSpline, gauges: GaugeSet) -> Complex[np.ndarray, "order 5 load"]:
    """The same with the structure of the truss."""
    return bridges(gauges, _strain(flex, gauges.radius))


@lru_cache(maxsize=4)
def _strain(flex: FlexSpline, radius: float) -> Complex[np.ndarray, "order 3 load"]:
    """Strains (rr, tt, rt) on the back of the collar at angle 0 [1/m, 1/N], for all bridges at this radius."""
    return strain_rows(flex.sector, radius) @ flex.fields


def prescribed(sector: Sector) -> Bool[np.ndarray, " dof"]:
    """Prescribed displacements of Fig. 5: the clamped edge is fixed, inner nodes of the band follow the wave generator.

    They follow it radially and slide along it.
    """
    given = np.repeat(sector.clamped, 3)
    given[0::3] |= sector.band & sector.layer(INNER)
    return given


def tooth_forces(sector: Sector, alpha_tooth: float) -> Float[np.ndarray, " dof"]:
    """Nodal forces F_tooth (Fig. 5) of a unit tangential tooth force [N/N], even over the face width.

    The reaction of the output torque acts on the flex spline, so the tangential force is negative for positive T_out.
    The flank is inclined by alpha_tooth [rad] from the radial direction, so its normal force also presses inwards.
    """
    rows = np.flatnonzero(sector.band & sector.layer(OUTER))
    share = np.full(len(rows), 1.0)
    share[[0, -1]] = 0.5
    forces = np.zeros(3 * len(sector.nodes))
    forces[3 * rows + 1] = -share / share.sum()
    forces[3 * rows] = tan(alpha_tooth) * forces[3 * rows + 1]
    return forces


@lru_cache(maxsize=4)
def solve_flex_spline(hat: SilkHat, alpha_tooth: float, count: int) -> FlexSpline:
    """Solve the flex spline for every load that the chain needs.

    Parameters
    ----------
    hat : SilkHat
    alpha_tooth : float
        Gear-tooth angle [rad].
    count : int
        Number of sectors around the circumference. The default of ``conf/mesh`` is 100, one for two teeth.
    """
    piece = sector(hat, count)
    given = prescribed(piece)
    band = np.flatnonzero(np.repeat(piece.band, 3))
    moved = np.zeros((len(given), BAND + len(band)))
    moved[0::3, WAVE_GENERATOR] = piece.band & piece.layer(INNER)
    forces = np.zeros_like(moved)
    forces[:, TEETH] = tooth_forces(piece, alpha_tooth)
    forces[band, BAND + np.arange(len(band))] = 1
    return FlexSpline(piece, cyclic.solve(piece, given, forces, moved))
