"""The flex spline: an elastic ring on springs, pressed by the cam from within and by the teeth from outside."""

from dataclasses import dataclass

import numpy as np

ELEMENTS = 360
POINTS = 120  # contact points, one at every third element
STEP = 2 * np.pi / ELEMENTS
NODES = STEP * np.arange(ELEMENTS)
CONTACTS = NODES[::3]
CAM_ANGLES = CONTACTS  # the cam is computed wherever its major axis is at a contact point
TORQUES = np.array([3.0, 10.0, 28.0, 46.0])
GRIDS = np.radians([[45, 135, 225, 315], [0] * 4, [90] * 4, [180] * 4, [270] * 4])  # s0 to s4
WINDOW = np.array([i for i in range(POINTS) if min(i % 60, 60 - i % 60) <= 20])  # within 60 degrees of a lobe

Waves = tuple[tuple[int, float, float], ...]  # (order, amplitude, phase)


@dataclass(frozen=True)
class Ring:
    """Dimensions of one flex spline with its wave generator and teeth, in SI units.

    A wave (n, a, phase) stands for a cos(n angle - phase). A soft spot (angle, half_width, ring, sleeve) lowers the
    stiffness of ring and sleeve there by two shares.
    """

    deflection: float = 0.22e-3  # w0 of the cam as designed
    wear: float = 0.0  # share of w0 that is lost
    cam_waves: Waves = ()  # form of the cam, turns with it [m]
    fixed_waves: Waves = ()  # offset or form, fixed to the flex spline [m]
    dent: tuple[float, float, float] = (0.0, 0.1, 0.0)  # depth [m], half width and angle on the cam [rad]
    soft_spots: tuple[tuple[float, float, float, float], ...] = ()
    wall_waves: Waves = ()  # stiffness of the ring around the circumference, as a share
    tooth_waves: Waves = ()  # stiffness and pitch of the teeth around the circumference, as a share of their force
    mesh_shift: float = 0.0  # the mesh is centred so far ahead of the lobes [rad]
    radius: float = 21.6e-3
    bending: float = 0.041  # E I [N m^2]
    stretching: float = 1.4e6  # E A [N]
    sleeve_radial: float = 2e6  # [N/m^2]
    sleeve_tangential: float = 2e7  # [N/m^2]
    cam_stiffness: float = 3e6  # bearing, per contact point [N/m]
    tooth_stiffness: float = 1e7  # per contact point [N/m]
    tooth_bend: float = 6e-6  # of a loaded tooth at 39 N m, makes lengths of shares [m]
    tooth_gap: float = 15e-6  # flank gap at 45 degrees from the lobe [m]
    flank: float = np.tan(np.radians(30))  # radial over tangential tooth force
    direct: float = 0.6  # share of the tooth force that enters the sleeve below the tooth
    spreading: float = 0.85  # wave n reaches the collar with spreading^n of its size
    grid: float = 0.1  # half length of a grid on the collar [rad]
    shear_gain: float = 5.2e-3  # bridge signal [mV/V] per N m
    twist_gain: float = 520.0  # bridge signal [mV/V] per slope of the deflection [m/rad]


def waves(terms: Waves, angle: np.ndarray) -> np.ndarray:
    """Sum of the waves at angles."""
    return sum((a * np.cos(n * angle - phase) for n, a, phase in terms), np.zeros_like(angle))


def bump(angle: np.ndarray, half_width: float) -> np.ndarray:
    """A smooth hill of height 1 around angle 0."""
    return np.exp(-(((angle + np.pi) % (2 * np.pi) - np.pi) ** 2) / (2 * half_width**2))


def spots(ring: Ring, angle: np.ndarray, column: int) -> np.ndarray:
    """Share of the stiffness that is left at angles: of the ring (column 2) or of the sleeve (column 3)."""
    left = np.ones_like(angle)
    for spot in ring.soft_spots:
        left = left * (1 - spot[column] * bump(angle - spot[0], spot[1]))
    return left


def stiffness(ring: Ring) -> np.ndarray:
    """Stiffness matrix of the ring on its springs, by finite differences.

    The first 360 unknowns are radial displacements w at the nodes, the others tangential ones v half a step ahead.
    """
    one = np.eye(ELEMENTS)
    before, after = np.roll(one, -1, axis=1), np.roll(one, 1, axis=1)  # pick the neighbour's value
    slope_v = (one - before) / STEP
    curvature = np.hstack([(before - 2 * one + after) / STEP**2, -slope_v]) / ring.radius**2
    strain = np.hstack([one, slope_v]) / ring.radius
    wall = (1 + waves(ring.wall_waves, NODES)) * spots(ring, NODES, 2)
    length = ring.radius * STEP
    radial, tangential = spots(ring, NODES, 3), spots(ring, NODES + STEP / 2, 3)
    bed = np.concatenate([ring.sleeve_radial * radial, ring.sleeve_tangential * tangential])
    bending = curvature.T @ (ring.bending * wall[:, None] * curvature)
    stretching = strain.T @ (ring.stretching * wall[:, None] * strain)
    return length * (bending + stretching + np.diag(bed))


def contact_loads(ring: Ring) -> np.ndarray:
    """Loads on the ring of unit forces: 120 radial ones of the cam, then 120 tangential ones of the teeth."""
    cam = np.zeros((2 * ELEMENTS, POINTS))
    node = 3 * np.arange(POINTS)
    cam[node, np.arange(POINTS)] = 1.0
    teeth = -ring.flank * cam
    for side in (node, node - 1):
        teeth[ELEMENTS + side % ELEMENTS, np.arange(POINTS)] -= (1 - ring.direct) / 2
    return np.hstack([cam, teeth])


def collar_kernel(ring: Ring, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What a grid shows of a unit line source at an angle away, and the slope of this kernel."""
    n = np.arange(1, 60)
    weight = ring.spreading**n * np.sinc(n * ring.grid / np.pi) / np.pi
    phase = n * angle[..., None]
    return 1 / (2 * np.pi) + np.cos(phase) @ weight, -np.sin(phase) @ (n * weight)


def bridge_rows(ring: Ring, grids: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signals of the bridges per unit displacement of the ring, and per unit force that enters the sleeve directly."""
    flow_gain = ring.shear_gain * 2 * np.pi * ring.radius**2

    def flow(angle: np.ndarray) -> np.ndarray:
        left = spots(ring, angle, 3)  # what a loose place cannot carry goes around it to the whole collar
        kernel = collar_kernel(ring, grids[..., None] - angle)[0]
        return flow_gain * (left * kernel + (1 - left) / (2 * np.pi))

    slope = collar_kernel(ring, grids[..., None] - NODES)[1]
    tangential = -ring.sleeve_tangential * spots(ring, NODES + STEP / 2, 3) * STEP * flow(NODES + STEP / 2)
    rows = np.concatenate([ring.twist_gain * STEP * slope, tangential], axis=-1)
    return rows.mean(axis=1), (ring.direct / ring.radius * flow(CONTACTS)).mean(axis=1)


def gaps(ring: Ring, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Reach of the cam beyond the free ring, and distance of the flanks, at contact points (cam angles, window)."""
    theta = CONTACTS[points]
    turned = theta - CAM_ANGLES[:, None]
    depth, width, at = ring.dent
    cam = ring.deflection * (1 - ring.wear) * np.cos(2 * turned) + waves(ring.cam_waves, turned)
    cam = cam + waves(ring.fixed_waves, theta) - depth * bump(turned - at, width)
    designed = ring.flank * np.cos(2 * turned) - (1 - ring.direct) / 2 * np.sin(2 * turned)
    apart = ring.tooth_gap * (1 - np.cos(2 * (turned - ring.mesh_shift))) ** 2
    apart = apart - ring.tooth_bend * waves(ring.tooth_waves, theta)
    return cam, apart + ring.deflection * designed


def gauge_table(ring: Ring, shifts: np.ndarray) -> np.ndarray:
    """Signals [mV/V] over cam angle, torque and bridge, with position errors of the bridges [rad]."""
    loads = contact_loads(ring)
    moved = np.linalg.solve(stiffness(ring), loads)
    compliance = loads.T @ moved
    rows, direct = bridge_rows(ring, GRIDS + shifts[:, None])
    signals = rows @ moved
    signals[:, POINTS:] += direct

    points = (np.arange(POINTS)[:, None] + WINDOW) % POINTS
    theta = CONTACTS[points]
    teeth = ring.tooth_stiffness * (1 + waves(ring.tooth_waves, theta))
    springs = np.concatenate([np.full_like(teeth, ring.cam_stiffness), teeth], axis=1)
    cam, apart = gaps(ring, points)
    reach = np.concatenate([cam, -apart], axis=1)
    both = np.concatenate([points, POINTS + points], axis=1)
    local = compliance[both[:, :, None], both[:, None, :]]

    near = np.minimum(WINDOW % 60, 60 - WINDOW % 60) <= 9
    active = np.tile(np.concatenate([near, near]), (POINTS, 1))
    table = np.empty((POINTS, len(TORQUES), len(GRIDS)))
    for j, torque in enumerate(TORQUES):
        forces, active = press(local, springs, reach, torque / ring.radius, active)
        table[:, j] = np.einsum("gak,ak->ag", signals[:, both], forces)
    return table


def press(
    local: np.ndarray, springs: np.ndarray, reach: np.ndarray, force: float, active: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Contact forces of cam and teeth that carry a tangential force together, by search for the points that touch.

    The circular spline turns against the teeth until their forces add up. Returns forces and touching points.
    """
    cases, count = reach.shape
    teeth = np.arange(count) >= count // 2
    for step in range(200):
        matrix = np.zeros((cases, count + 1, count + 1))
        matrix[:, :count, :count] = local * active[:, :, None]
        matrix[:, range(count), range(count)] += np.where(active, 1 / springs, 1.0)
        matrix[:, :count, -1] = -1.0 * (active & teeth)
        matrix[:, -1, :count] = teeth
        right = np.concatenate([reach * active, np.full((cases, 1), force)], axis=1)
        solution = np.linalg.solve(matrix, right[..., None])[..., 0]
        forces = solution[:, :count] * active
        inside = reach + solution[:, -1:] * teeth - np.einsum("aij,aj->ai", local, forces)
        wrong = (inside > 0) != active
        if not wrong.any():
            return forces, active
        if step >= 12:  # all at once may go round in circles; one at a time comes to an end
            wrong &= np.cumsum(wrong, axis=1) == 1
        active = active ^ wrong
    raise RuntimeError("the search for the touching points did not end")
