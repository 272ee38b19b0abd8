"""Structure: sleeve and collar of the flex spline as a frame of bars, solved by its block-circulant symmetry."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

SECTORS = 72
STEP = 2 * np.pi / SECTORS
ANGLES = STEP * np.arange(SECTORS)
# Radius and height of the rings of nodes in metres: clamp, three rings of the collar, corner, five rings of the sleeve.
RADII = 1e-3 * np.array([31.0, 28.5, 26.2, 24.0, 21.6, 21.6, 21.6, 21.6, 21.6, 21.6])
HEIGHTS = 1e-3 * np.array([0.0, 0.0, 0.0, 0.0, 0.0, 7.0, 14.0, 20.0, 26.0, 32.0])
RINGS, CORNER, GAUGE_RING, CONTACT_RINGS = len(RADII), 4, 1, (8, 9)
WALLS = np.where(np.arange(RINGS - 1) < CORNER, 0.6e-3, 0.4e-3)  # between ring k and k + 1
YOUNG, SHEAR = 209e9, 80.7e9  # Pa
PITCH_RADIUS = RADII[-1]
CONTACT_HEIGHT = HEIGHTS[list(CONTACT_RINGS)].mean()
CONTACT_STIFFNESS = 4e6  # N/m, balls between the cam and one node
CLAMP_STIFFNESS = 2e8  # N/m, bolted edge under one node
GAUGE_SIDE = -1.0  # the gauges lie on the face of the collar towards the sleeve
PRESSURE_ANGLE = np.radians(30.0)


@dataclass(frozen=True)
class Member:
    """A spring on a measure with terms (ring, sector, weights of radial, tangential and axial displacement)."""

    stiffness: float
    terms: tuple
    place: str = ""  # "sleeve" or "clamp" where damage may act


@dataclass(frozen=True)
class Damage:
    """Members of a place that lose a share of their stiffness, from a sector on."""

    place: str
    sector: int
    share: float
    width: int = 1


def _axes(sector: float) -> np.ndarray:
    """Radial, tangential and axial direction at a sector, one a row."""
    cos, sin = np.cos(STEP * sector), np.sin(STEP * sector)
    return np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])


def _along(a: tuple, b: tuple, direction: np.ndarray | None = None) -> tuple[tuple, float]:
    """Displacement of node b against node a along a direction, else along their line, and their distance."""
    places = [RADII[ring] * _axes(sector)[0] + HEIGHTS[ring] * _axes(sector)[2] for ring, sector in (a, b)]
    length = float(np.linalg.norm(places[1] - places[0]))
    direction = (places[1] - places[0]) / length if direction is None else direction
    return ((*a, -_axes(a[1]) @ direction), (*b, _axes(b[1]) @ direction)), length


def _rotation(a: tuple, b: tuple, normal: np.ndarray, sign: float = 1.0) -> tuple:
    """Rotation of the bar from a to b towards its normal."""
    terms, length = _along(a, b, normal)
    return tuple((ring, sector, sign * weights / length) for ring, sector, weights in terms)


def _twist(k: int) -> tuple:
    """Twist of the panel of the collar between rings k and k + 1, per m: the change of its tangential slope."""
    rise = RADII[k] - RADII[k + 1]
    ends = ((k, 0, -1.0), (k, 1, 1.0), (k + 1, 0, 1.0), (k + 1, 1, -1.0))
    return tuple((ring, sector, sign * np.eye(3)[2] / (RADII[ring] * STEP * rise)) for ring, sector, sign in ends)


@lru_cache
def members() -> tuple[Member, ...]:
    """All members that start in sector 0."""
    found = [Member(CLAMP_STIFFNESS, ((0, 0, axis),), "clamp") for axis in np.eye(3)]
    found += [Member(CONTACT_STIFFNESS, ((ring, 0, np.eye(3)[0]),)) for ring in CONTACT_RINGS]
    last = ()
    for k, wall in enumerate(WALLS):
        rise = np.hypot(RADII[k + 1] - RADII[k], HEIGHTS[k + 1] - HEIGHTS[k])
        width, place = STEP * (RADII[k] + RADII[k + 1]) / 2, "sleeve" if k > CORNER else ""
        found.append(Member(0.75 * YOUNG * wall * width / rise, _along((k, 0), (k + 1, 0))[0]))
        for a, b in (((k, 0), (k + 1, 1)), ((k, 1), (k + 1, 0))):  # the diagonals carry the shear of the wall
            terms, length = _along(a, b)
            found.append(Member(SHEAR * wall * length**2 / (2 * width * rise), terms, place))
        terms, length = _along((k + 1, 0), (k + 1, 1))
        found.append(Member(0.75 * YOUNG * wall * rise / length, terms, place))
        normal = np.array([HEIGHTS[k] - HEIGHTS[k + 1], 0.0, RADII[k + 1] - RADII[k]]) / rise
        turn = _rotation((k, 0), (k + 1, 0), normal)  # meridian bends between this bar and the last
        found.append(Member(YOUNG * wall**3 / 10.9 * width / rise, turn + last))
        last = _rotation((k, 0), (k + 1, 0), normal, -1.0)
        if k < CORNER:
            found.append(Member(YOUNG * wall**3 / 7.8 * width * rise, _twist(k)))
        if k >= CORNER - 1:  # rings of the sleeve bend between two bars of the hoop
            ahead = _rotation((k + 1, 0), (k + 1, 1), _axes(0.5)[0])
            behind = _rotation((k + 1, -1), (k + 1, 0), _axes(-0.5)[0], -1.0)
            found.append(Member(YOUNG * wall**3 / 10.9 * rise / length, ahead + behind, place))
    return tuple(found)


def _wave_row(terms: tuple) -> np.ndarray:
    """Measure of the terms for displacements exp(i n angle), for all waves n (SECTORS, 3 RINGS)."""
    row = np.zeros((SECTORS, RINGS, 3), complex)
    waves = np.fft.fftfreq(SECTORS, 1 / SECTORS)
    for ring, sector, weights in terms:
        row[:, ring] += np.exp(1j * waves * STEP * sector)[:, None] * weights
    return row.reshape(SECTORS, -1)


def _solve_waves(loads: np.ndarray) -> np.ndarray:
    """Displacements (..., SECTORS, 3 RINGS) under loads that are given as waves, one small system a wave."""
    rows = [(member.stiffness, _wave_row(member.terms)) for member in members()]
    stiffness = sum(k * row.conj()[:, :, None] * row[:, None, :] for k, row in rows)
    waves = np.linalg.solve(stiffness, np.moveaxis(loads, 0, -1))
    return np.fft.ifft(np.moveaxis(waves, -1, 0), axis=1).real


def _local_rows(damages: tuple[Damage, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Measures of the damaged members (many, SECTORS, 3 RINGS) and the stiffness they lose."""
    rows, lost = [], []
    for damage in damages:
        for member in members():
            for sector in range(damage.sector, damage.sector + damage.width * (member.place == damage.place)):
                row = np.zeros((SECTORS, RINGS, 3))
                for ring, offset, weights in member.terms:
                    row[(sector + offset) % SECTORS, ring] += weights
                rows.append(row.reshape(SECTORS, -1))
                lost.append(damage.share * member.stiffness)
    return np.array(rows), np.array(lost)


def influence(positions: np.ndarray, normal_share: float, damages: tuple[Damage, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Gauge signals per displacement of the cam and per torque on the teeth of each sector, by reciprocity.

    Parameters
    ----------
    positions : (gauges,) array
        Angles of the pairs of +-45 degree grids, in rad.
    normal_share : float
        Share of the normal strain in the signal of shear.
    damages : tuple of Damage
        They break the symmetry and enter as a correction of low rank.
    """
    ring, waves = GAUGE_RING, np.fft.fftfreq(SECTORS, 1 / SECTORS)
    (ahead, length), (back, _) = _along((ring, 0), (ring + 1, 1)), _along((ring, 1), (ring + 1, 0))
    grid = (1 + normal_share) * _wave_row(ahead) - (1 - normal_share) * _wave_row(back)
    strain = -grid / length - GAUGE_SIDE * WALLS[ring] * _wave_row(_twist(ring))
    gauge = 1e3 * strain.conj()  # two active pairs, gauge factor 2: 1e3 mV/V times the difference of strains
    turned = gauge * np.exp(-1j * waves * (np.asarray(positions)[:, None] - STEP / 2))[:, :, None]
    reply = _solve_waves(turned)
    if damages:
        rows, lost = _local_rows(damages)
        spread = _solve_waves(np.fft.fft(rows, axis=1))
        inner = np.diag(1 / lost) - np.einsum("asd,bsd->ab", rows, spread)
        released = np.einsum("asd,gsd->ag", rows, reply)
        reply = reply + np.einsum("ag,asd->gsd", np.linalg.solve(inner, released), spread)
    reply = reply.reshape(len(positions), SECTORS, RINGS, 3)[:, :, list(CONTACT_RINGS)]
    cone = HEIGHTS[list(CONTACT_RINGS)] / CONTACT_HEIGHT  # the sleeve opens as a cone
    tooth = -(reply[..., 1] + np.tan(PRESSURE_ANGLE) * reply[..., 0]).mean(axis=-1) / PITCH_RADIUS
    return CONTACT_STIFFNESS * reply[..., 0] @ cone, tooth
