"""Influence maps: gauge signals over the wave-generator angle, s(psi, T_out) = A(psi) + T_out B(psi).

The truss of one structure is linear, unless the wave generator only presses (:mod:`swgsim.chain.contact`). Its response
to the wave generator (A) and to a unit output torque (B) is computed once over the angle; a recording evaluates both
along phi_in(t) and T_out(t). Three faults of the paper act here:

- eccentric wave generator: :func:`boundary_conditions` adds u_ecc to the imposed displacement,
- tip tooth crack: :func:`boundary_conditions` reduces F_tooth,
- root tooth crack: :func:`change_by_cracks` adds the change of the signals by bars with reduced k_bar. The truss stays
  as it is. The bars are those of :attr:`~swgsim.flexspline.flexspline.FlexSpline.crossing_stiffness`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from jaxtyping import Complex, Float, Int
from scipy import linalg

from swgsim.chain.contact import pressed
from swgsim.effects.base import Crack, Effect, overrides
from swgsim.flexspline.cyclic import order_weights, orders
from swgsim.flexspline.flexspline import BAND, TEETH, WAVE_GENERATOR, FlexSpline, gauge_response
from swgsim.flexspline.gauges import GaugeSet, offsets
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, StructureFactors
from swgsim.gear.gear import WaveGenerator

# Highest order per wave-generator revolution that the maps keep, and the angles at which they are sampled.
MAP_ORDERS = 120
ANGLES = 256
PSI = 2 * np.pi / ANGLES * np.arange(ANGLES)
# Angles of a map between which long recordings are interpolated; 17 to a wave of the highest order.
FINE_ANGLES = 2048

# A wave generator that only presses touches another part of the sleeve under another load, so its maps are chords over
# a step of the load [N m]. Its contact is found at every so many of the angles.
LOAD_STEP, EVERY = 3.5, 8

# Points per sector at which the tooth forces are sampled; odd, so that one is at the node.
SUBDIVISION = 5


@dataclass(frozen=True)
class InfluenceMap:
    """Fourier coefficients of A [mV/V] and B [mV/V per N m] over the wave-generator angle.

    Attributes
    ----------
    coefficients : array (2, sensor, order)
        For A and B; the signal is the real part of sum_k c_k exp(i k psi).
    """

    coefficients: Complex[np.ndarray, "2 5 order"]

    @cached_property
    def fine(self) -> Float[np.ndarray, "angle 2*5"]:
        """A and B of all sensors at FINE even angles, after the last of them and before the first two."""
        lines = self.coefficients.reshape(-1, self.coefficients.shape[-1]).copy()
        lines[:, 1:] /= 2
        values = np.fft.irfft(lines, FINE_ANGLES, norm="forward").T
        return np.concatenate([values[-1:], values, values[:2]])

    @cached_property
    def largest(self) -> Float[np.ndarray, "2 order"]:
        """The largest coefficient of all sensors."""
        return np.abs(self.coefficients).max(axis=1)

    def __call__(self, psi: Float[np.ndarray, " time"]) -> Float[np.ndarray, "2 5 time"]:
        """A and B at given angles [rad]."""
        return (self.coefficients @ harmonics(psi, np.arange(self.coefficients.shape[-1]))).real


def harmonics(psi: Float[np.ndarray, " time"], orders: Int[np.ndarray, " order"]) -> Complex[np.ndarray, "order time"]:
    """exp(i k psi) for ascending orders k, by repeated multiplication."""
    turns = np.empty((len(orders), len(psi)), complex)
    steps = np.diff(orders, prepend=0).tolist()
    powers = {step: np.exp(1j * step * psi) if step else np.ones_like(psi) for step in set(steps)}
    before: np.ndarray | float = 1.0
    for turn, step in zip(turns, steps, strict=True):
        before = np.multiply(before, powers[step], out=turn)
    return turns


def ellipse(
    wave_generator: WaveGenerator, radius: float, psi: Float[np.ndarray, " psi"], theta: Float[np.ndarray, " theta"]
) -> Float[np.ndarray, "psi theta"]:
    """Radial displacement u_elliptical of the sleeve by the wave generator with its major axis at psi [m] (Fig. 5).

    The semi-axes are radius +- w0. The mean is subtracted, as the rim bends without stretching.

    Parameters
    ----------
    wave_generator : WaveGenerator
    radius : float
        Mid-surface radius of the sleeve [m].
    psi, theta : arrays
        Angles of the major axis, and positions around the flex spline, from gauge s1 [rad].
    """
    a, b = radius + wave_generator.w0, radius - wave_generator.w0

    def polar(x: np.ndarray) -> np.ndarray:
        return a * b / np.sqrt((a**2 + b**2) / 2 - (a**2 - b**2) / 2 * np.cos(2 * x))

    mean = polar(np.linspace(0, 2 * np.pi, 64, endpoint=False)).mean()
    return polar(theta - psi[:, None]) - mean


def fine_angles(sectors: int) -> Float[np.ndarray, " theta"]:
    """Angles [rad] around the circumference, SUBDIVISION to a sector, centred on its nodes."""
    inside = (np.arange(SUBDIVISION) - SUBDIVISION // 2) / SUBDIVISION
    return (2 * np.pi / sectors * (np.arange(sectors)[:, None] + inside)).ravel()


@lru_cache(maxsize=4096)
def lobes(wave_generator: WaveGenerator, radius: float, effects: tuple[Effect, ...]) -> complex:
    """Change of the two lobes by effects, as order 2 of the displacement that turns with the wave generator.

    The modulus is their stroke relative to the ideal ellipse; half of the angle [rad] is their lead.
    """
    psi, theta = (np.linspace(0, 2 * np.pi, points, endpoint=False) for points in (16, 64))
    ideal = displacement = ellipse(wave_generator, radius, psi, theta)
    for effect in effects:
        displacement = effect.wave_generator(displacement, psi, theta)
    turning = np.exp(2j * (theta - psi[:, None]))
    return complex((displacement * turning).mean() / (ideal * turning).mean())


@lru_cache(maxsize=64)
def _displacement(
    wave_generator: WaveGenerator, radius: float, sectors: int, effects: tuple[Effect, ...]
) -> Float[np.ndarray, "psi theta"]:
    """Imposed displacement at the angles of the maps [m]; units share what the first of their effects do."""
    if not effects:
        return ellipse(wave_generator, radius, PSI, fine_angles(sectors))
    before = _displacement(wave_generator, radius, sectors, effects[:-1])
    return effects[-1].wave_generator(before, PSI, fine_angles(sectors))


def boundary_conditions(
    flex: FlexSpline,
    displacement: Float[np.ndarray, "psi theta"],
    effects: Sequence[Effect],
    psi: Float[np.ndarray, " psi"],
) -> tuple[Float[np.ndarray, "psi sector"], Float[np.ndarray, "psi sector"]]:
    """Loads of the truss (Fig. 5): displacement u_elliptical + u_ecc [m] and tooth force F_tooth per T_out [N/(N m)].

    The teeth share the force in proportion to the engagement depth, which is the imposed displacement where it points
    outwards. For the ideal gear F_tooth ~ cos 2 theta over +-45 degrees of each lobe. A sector gets the force over its
    width, so that the signals do not ripple as nodes pass.

    Parameters
    ----------
    flex : FlexSpline
    displacement : array (psi, theta)
        Of the ideal wave generator, at :func:`fine_angles` [m].
    effects : sequence of Effect
    psi : array (psi,)
        Wave-generator angles relative to the flex spline [rad].
    """
    theta = fine_angles(flex.sector.count)
    for effect in effects:
        displacement = effect.wave_generator(displacement, psi, theta)
    return _loads(flex, displacement, effects, psi)


def _loads(
    flex: FlexSpline,
    displacement: Float[np.ndarray, "psi theta"],
    effects: Sequence[Effect],
    psi: Float[np.ndarray, " psi"],
) -> tuple[Float[np.ndarray, "psi sector"], Float[np.ndarray, "psi sector"]]:
    """Loads of the truss under the displacement of the actual wave generator, as in :func:`boundary_conditions`."""
    depth, theta = displacement, fine_angles(flex.sector.count)
    for effect in effects:
        depth = effect.engaged(depth, psi, theta)
    share = np.maximum(depth, 0)
    for effect in effects:
        share = effect.mesh(share, psi, theta)
    # The sum is taken before `carried`: a tooth that loses force by it does not pass the loss to the others.
    total = share.sum(axis=1, keepdims=True)
    for effect in effects:
        share = effect.carried(share, psi, theta)
    of_sectors = share.reshape(len(psi), flex.sector.count, SUBDIVISION) @ np.ones(SUBDIVISION)
    at_nodes = displacement[:, SUBDIVISION // 2 :: SUBDIVISION]
    return at_nodes, of_sectors / (total * flex.tooth_radius)


def influence_map(
    flex: FlexSpline, wave_generator: WaveGenerator, gauges: GaugeSet, effects: Sequence[Effect] = (),
    factors: StructureFactors = EXACT_STRUCTURE, load: float = 0.0,
) -> InfluenceMap:  # fmt: skip
    """The influence map of one structure.

    Parameters
    ----------
    flex : FlexSpline
    wave_generator : WaveGenerator
    gauges : GaugeSet
    effects : sequence of Effect
        Effects on wave generator, mesh or structure.
    factors : StructureFactors
        By which the structure differs from the truss; cracks are those of the truss.
    load : float
        Output torque [N m] about which the map holds, if the wave generator only presses; else it holds for all.
    """
    loading = tuple(effect for effect in effects if overrides(effect, "wave_generator", "engaged", "mesh", "carried"))
    softening = StructureFactors(compliance=factors.compliance)
    amplitudes = load_amplitudes(flex, wave_generator, loading, softening, load)
    response = gauge_response(flex, gauges, factors)
    cracks = [crack for effect in effects for crack in effect.cracks()]
    of_loads = response[:, :, [WAVE_GENERATOR, TEETH]]
    if cracks:
        of_loads = of_loads + change_by_cracks(flex, response, cracks)
    values = (amplitudes @ np.moveaxis(of_loads, 2, 0)).real.sum(axis=1)
    values[0] += offsets(gauges)
    coefficients = np.fft.rfft(values, axis=1)[:, : MAP_ORDERS + 1] / ANGLES
    coefficients[:, 1:] *= 2
    return InfluenceMap(np.swapaxes(coefficients, 1, 2))


@lru_cache(maxsize=64)
def load_amplitudes(
    flex: FlexSpline, wave_generator: WaveGenerator, effects: tuple[Effect, ...], factors: StructureFactors, load: float
) -> Complex[np.ndarray, "2 2 psi order"]:
    """Circumferential orders of the radial displacement [m] and of the tooth forces [N], at no load and per N m of it.

    Gears that differ in their gauges only share them.
    """
    sectors = flex.sector.count
    deforming = tuple(effect for effect in effects if overrides(effect, "wave_generator"))
    loads = _loads(flex, _displacement(wave_generator, flex.sector.hat.radius, sectors, deforming), effects, PSI)
    asked, per_torque = (np.fft.rfft(load, axis=1) / sectors for load in loads)
    amplitudes = np.zeros((2, 2, *asked.shape), complex)
    amplitudes[0, WAVE_GENERATOR], amplitudes[1, TEETH] = asked, per_torque
    if wave_generator.presses_only:
        asked[:, 0] += wave_generator.interference
        torques = load - LOAD_STEP / 2, load + LOAD_STEP / 2
        low, high = (pressed(flex, factors, asked, torque * per_torque, PSI, EVERY) for torque in torques)
        amplitudes[1, WAVE_GENERATOR] = (high - low) / LOAD_STEP
        amplitudes[0, WAVE_GENERATOR] = (low + high) / 2 - load * amplitudes[1, WAVE_GENERATOR]
    return amplitudes * order_weights(sectors)


def change_by_cracks(
    flex: FlexSpline, response: Complex[np.ndarray, "order 5 load"], cracks: Sequence[Crack]
) -> Complex[np.ndarray, "order 5 2"]:
    """Change of the response to both loads by root tooth cracks (reduced k_bar, section II-B).

    Cracks remove the stiffness D [N/m] between the columns of nodes on their two sides. C [m/N] is the compliance
    between these nodes, and u0 [m] their displacement in the sound structure. Then u = (1 - C D)^-1 u0, and the forces
    D u on the sound structure replace the cracks (Woodbury), so no new factorisation is needed. With the signals S per
    force the change is S D (1 - C D)^-1 u0. The factors before u0 belong to the gauges, and u0 is linear in each
    circumferential order of the load, so the crack changes the response to that order.

    Parameters
    ----------
    flex : FlexSpline
    response : array (order, 5, load)
        Bridge signals per load [mV/V per m, per N].
    cracks : sequence of Crack
    """
    sector = flex.sector
    gaps = np.unique([sector.gap(crack.angle) for crack in cracks])
    columns = np.stack([gaps, gaps + 1], axis=1).ravel()
    turns = np.exp(1j * sector.pitch * np.outer(orders(sector.count), columns))
    lost = 1 - remaining_stiffness(cracks, flex)[gaps]
    lost_stiffness = linalg.block_diag(*[share * flex.crossing_stiffness for share in lost])
    compliance = np.block([[flex.band_compliance[(i - j) % sector.count] for j in columns] for i in columns])
    signal = np.fft.irfft(response[:, :, BAND:], sector.count, axis=0)[-columns % sector.count]  # (column, 5, dof)
    per_force = signal.swapaxes(1, 2).reshape(len(lost_stiffness), -1)
    per_displacement = np.linalg.solve(
        np.eye(len(lost_stiffness)) - lost_stiffness.T @ compliance.T, lost_stiffness.T @ per_force
    )
    around = turns @ per_displacement.reshape(len(columns), -1)  # (order, dof 5)
    fields = flex.fields[:, flex.band][:, :, [WAVE_GENERATOR, TEETH]]  # (order, dof, load)
    return around.reshape(len(turns), fields.shape[1], -1).swapaxes(1, 2) @ fields


def remaining_stiffness(cracks: Sequence[Crack], flex: FlexSpline) -> Float[np.ndarray, " sector"]:
    """Remaining stiffness of the bars from each sector to the next [-].

    A crack weakens one tooth pitch of their length, and the compliances of neighbouring cracks add.
    """
    tooth_pitch, longer = 2 * np.pi / flex.sector.hat.teeth, np.zeros(flex.sector.count)
    for crack in cracks:
        longer[flex.sector.gap(crack.angle)] += (1 / crack.stiffness_ratio - 1) * tooth_pitch
    return flex.sector.pitch / (flex.sector.pitch + longer)
