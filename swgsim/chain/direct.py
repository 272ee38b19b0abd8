"""Direct solution of the whole truss, one sparse solve per instant: the reference for tests and benchmarks."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy import sparse

from swgsim.chain.contact import pressed
from swgsim.chain.influence import boundary_conditions, ellipse, fine_angles, remaining_stiffness
from swgsim.effects.base import Effect
from swgsim.flexspline.flexspline import FlexSpline, prescribed, tooth_forces
from swgsim.flexspline.gauges import bridges, offsets, strain_rows
from swgsim.flexspline.lattice import INNER
from swgsim.flexspline.truss import Factorised, Truss
from swgsim.gear.gear import Gear


class DirectSolver:
    """Factorises the whole truss of a gear and solves it for one wave-generator angle after the other.

    Parameters
    ----------
    flex : FlexSpline
        Gives the mesh, and the compliance where the wave generator only presses; else its solution is not used.
    gear : Gear
    effects : sequence of Effect
        Effects on wave generator, mesh or structure.
    """

    def __init__(self, flex: FlexSpline, gear: Gear, effects: Sequence[Effect] = ()) -> None:
        self.flex, self.gear, self.effects = flex, gear, effects
        sector = flex.sector
        truss = sector.truss()
        stiffness = truss.stiffness.reshape(sector.count, -1).copy()
        crossing = sector.band[sector.bars[:, 0]] & sector.band[sector.bars[:, 1]] & (sector.bars[:, 2] == 1)
        cracks = [crack for effect in effects for crack in effect.cracks()]
        stiffness[:, crossing] *= remaining_stiffness(cracks, flex)[:, None]
        turn = self._to_cylindrical()
        matrix = turn @ Truss(truss.nodes, truss.bars, stiffness.ravel()).matrix @ turn.T
        self.factorised = Factorised(matrix.tocsc(), np.tile(prescribed(sector), sector.count))
        self.unit_force = tooth_forces(sector, gear.transmission.alpha_tooth)
        self.touching = np.flatnonzero(sector.band & sector.layer(INNER)) * 3
        self.rows = self._gauge_rows()

    def _to_cylindrical(self) -> sparse.csr_array:
        """Rotation of all displacements from Cartesian to cylindrical components."""
        sector = self.flex.sector
        blocks = []
        for k in range(sector.count):
            c, s = np.cos(k * sector.pitch), np.sin(k * sector.pitch)
            blocks += [np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])] * len(sector.nodes)
        return sparse.csr_array(sparse.block_diag(blocks))

    def _gauge_rows(self) -> Float[np.ndarray, "5 dof"]:
        """Rows from all displacements to the bridge signals, by trigonometric interpolation around the collar."""
        sector = self.flex.sector
        per_order = bridges(self.gear.gauges, strain_rows(sector, self.gear.gauges.radius))
        # A displacement at sector k counts as sum_n row_n exp(-i n theta_k) / N.
        return np.fft.irfft(np.conj(per_order), sector.count, axis=0).swapaxes(0, 1).reshape(5, -1)

    def signals(
        self, psi: Float[np.ndarray, " time"], T_out: Float[np.ndarray, " time"]
    ) -> Float[np.ndarray, "5 time"]:
        """Bridge signals [mV/V] at wave-generator angles [rad] and output torques [N m], one solve each."""
        count, dof = self.flex.sector.count, 3 * len(self.flex.sector.nodes)
        ideal = ellipse(self.gear.wave_generator, self.flex.sector.hat.radius, psi, fine_angles(count))
        displacement, force = boundary_conditions(self.flex, ideal, self.effects, psi)
        force = T_out[:, None] * force
        if self.gear.wave_generator.presses_only:
            asked = np.fft.rfft(displacement + self.gear.wave_generator.interference, axis=1) / count
            lifted = pressed(self.flex, self.gear.factors, asked, np.fft.rfft(force, axis=1) / count, psi)
            displacement = np.fft.irfft(lifted * count, count, axis=1)
        signals = np.empty((5, len(psi)))
        for i in range(len(psi)):
            moved = np.zeros((count, dof))
            moved[:, self.touching] = displacement[i, :, None]
            loads = force[i, :, None] * self.unit_force
            signals[:, i] = self.rows @ self.factorised.solve(loads.ravel(), moved.ravel())
        return signals + offsets(self.gear.gauges)[:, None]
