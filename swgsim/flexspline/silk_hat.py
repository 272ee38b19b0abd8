"""Geometry of the silk-hat flex spline and its truss, which repeats around the circumference."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from swgsim.common.checks import require, require_integer, require_positive
from swgsim.flexspline.lattice import wall_bars
from swgsim.flexspline.truss import Truss


@dataclass(frozen=True)
class SilkHat:
    """Dimensions of the flex spline [m] and its steel.

    The default is a size 17, ratio 100 gear. The pitch radius (1.7 in / 2), wall and contact width follow physics.md
    section 2; sleeve length and collar are estimates for a short hat.

    Attributes
    ----------
    radius : float
        Mid-surface radius of the sleeve.
    length : float
        Length of the sleeve, from the collar (z = 0) to the open end.
    fillet : float
        Radius of the mid-surface where the sleeve turns into the collar.
    band : float
        Width of the band at the open end that touches the wave generator and carries the teeth.
    clamp_radius : float
        Radius at which the collar is clamped to the housing.
    wall, collar : float
        Thickness of sleeve and collar.
    E : float
        Young's modulus [Pa]; 40CrNiMoA.
    teeth : int
        Number of teeth of the flex spline.
    """

    radius: float = 21.2e-3
    length: float = 25e-3
    band: float = 11e-3
    fillet: float = 1.5e-3
    clamp_radius: float = 31e-3
    wall: float = 0.43e-3
    collar: float = 0.8e-3
    E: float = 209e9
    teeth: int = 200

    def __post_init__(self) -> None:
        lengths = ("radius", "length", "fillet", "band", "clamp_radius", "wall", "collar")
        require_positive("the flex spline", E=self.E, **{name: getattr(self, name) for name in lengths})
        require_integer("the flex spline", "teeth", self.teeth, low=60, high=640)
        for name in ("wall", "collar"):
            # Thicker than this it is no shell; thinner, the lattice's bars are all but parallel to it.
            require("the flex spline", name, getattr(self, name), low=self.radius / 500, high=self.radius / 5)
        if self.band + self.fillet >= self.length:
            raise ValueError(f"band {self.band} m and fillet {self.fillet} m must fit the length {self.length} m")
        if self.clamp_radius <= self.radius + self.fillet:
            raise ValueError(
                f"clamp radius {self.clamp_radius} m must be above radius and fillet, {self.radius + self.fillet} m"
            )


@dataclass(frozen=True)
class Sector:
    """One of ``count`` equal sectors of the truss; bars lead to the same or to the next sector.

    Attributes
    ----------
    nodes : array (node, 3)
        Radius, angle (0) and axial position of the nodes of the sector [m, rad, m]; node ``2 m + layer`` is point m of
        the meridian, which runs from the open end over the corner to the clamped edge.
    bars : array (bar, 3)
        First node, second node, and 1 where the second node belongs to the next sector.
    stiffness : array (bar,)
        E A / L [N/m].
    clamped, band : boolean arrays (node,)
        Nodes on the clamped edge; nodes (of both layers) where wave generator and teeth act.
    """

    hat: SilkHat
    count: int
    nodes: Float[np.ndarray, "node 3"]
    bars: Int[np.ndarray, "bar 3"]
    stiffness: Float[np.ndarray, " bar"]
    clamped: Bool[np.ndarray, " node"]
    band: Bool[np.ndarray, " node"]

    @property
    def pitch(self) -> float:
        """Angle of one sector [rad]."""
        return 2 * np.pi / self.count

    def gap(self, angle: float) -> int:
        """The sector whose gap to the next one begins at or holds an angle [rad]."""
        return int(np.floor(angle / self.pitch + 1e-9)) % self.count

    def layer(self, layer: int) -> Bool[np.ndarray, " node"]:
        """Mask of the nodes of one layer (INNER or OUTER)."""
        return np.arange(len(self.nodes)) % 2 == layer

    def positions(self, sector: int | np.ndarray) -> Float[np.ndarray, "node 3"]:
        """Cartesian positions of the nodes in a sector [m]."""
        r, _, z = self.nodes.T
        angle = self.pitch * sector
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)

    def truss(self) -> Truss:
        """The whole flex spline; node ``i`` of sector ``k`` is node ``k * len(nodes) + i``."""
        n = len(self.nodes)
        nodes = np.concatenate([self.positions(k) for k in range(self.count)])
        k = np.arange(self.count)[:, None]
        first = (k * n + self.bars[:, 0]).ravel()
        second = ((k + self.bars[:, 2]) % self.count * n + self.bars[:, 1]).ravel()
        return Truss(nodes, np.stack([first, second], axis=1), np.tile(self.stiffness, self.count))


def meridian(hat: SilkHat, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mid-surface points (r, z) [m], unit normals and wall thickness [m] from the open end to the clamped edge.

    Sleeve, fillet and collar; the spacing follows the circumferential one so that cells stay nearly square. The
    thickness goes linearly from wall to collar along the fillet.
    """
    pitch = 2 * np.pi / count
    step = pitch * hat.radius
    z_band = hat.length - hat.band

    def cells(length: float) -> int:
        return max(1, round(length / step))

    band_z = np.linspace(hat.length, z_band, cells(hat.band) + 1)[:-1]
    sleeve_z = np.linspace(z_band, hat.fillet, cells(z_band - hat.fillet) + 1)[:-1]
    angle = np.linspace(0, np.pi / 2, cells(hat.fillet * np.pi / 2) + 1)[:-1]
    edge = hat.radius + hat.fillet
    collar_r = np.geomspace(edge, hat.clamp_radius, max(3, round(np.log(hat.clamp_radius / edge) / pitch)) + 1)

    z_straight = np.concatenate([band_z, sleeve_z])
    arc = np.stack([edge - hat.fillet * np.cos(angle), hat.fillet * (1 - np.sin(angle))], axis=1)
    points = np.concatenate([
        np.stack([np.full_like(z_straight, hat.radius), z_straight], axis=1),
        arc,
        np.stack([collar_r, np.zeros_like(collar_r)], axis=1),
    ])  # fmt: skip
    turn = np.concatenate([np.zeros_like(z_straight), angle, np.full_like(collar_r, np.pi / 2)])
    normals = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    thickness = hat.wall + (hat.collar - hat.wall) * turn / (np.pi / 2)
    return points, normals, thickness


def sector(hat: SilkHat, count: int) -> Sector:
    """One sector of the flex spline's truss.

    Parameters
    ----------
    hat : SilkHat
    count : int
        Number of sectors around the circumference: even, at least 24.

    Raises
    ------
    ValueError
        If the count is odd or too small, or the cells become too oblong for a lattice.
    """
    require_integer("the mesh", "sectors", count, low=24, high=2000)
    if count % 2:
        raise ValueError(f"sectors of the mesh is {count}, must be even: the wave generator has two lobes")
    points, normals, thickness = meridian(hat, count)
    offset = 0.5 * thickness[:, None] * normals
    pair = np.stack([points - offset, points + offset], axis=1)  # (meridian, layer, rz)
    r, z = pair.reshape(-1, 2).T
    nodes = np.stack([r, np.zeros_like(r), z], axis=1)

    bars, stiffness = wall_bars(hat.E, points, thickness, 2 * np.pi / count)
    on_edge = np.repeat(np.arange(len(points)) == len(points) - 1, 2)
    on_band = np.repeat((points[:, 1] >= hat.length - hat.band - 1e-9), 2)
    return Sector(hat, count, nodes, bars, stiffness, on_edge, on_band)
