"""A wall as a two-layer lattice of bars.

Bars run in circumferential and meridional direction and along both diagonals of every cell, each direction once within
the two layers and once crossing from one layer to the other, plus bars through the thickness. The areas follow from
equal strain energy of the lattice and of an isotropic plate (A. Hrennikoff, J. Appl. Mech. 8 (1941) A169),
which for bars means Poisson's ratio 1/3. With two thirds of the stiffness in the crossing bars, which bending does not
strain, both the membrane stiffness E t and the bending stiffness E t^3 / 12 of the plate come out right with the two
layers on the two surfaces of the wall.
"""

import numpy as np
from jaxtyping import Float, Int

CROSSING = 2 / 3
INNER, OUTER = 0, 1

# Stiffness of the bars through the thickness relative to the wall; they keep the layers apart, nearly rigid.
RIGID = 100


def wall_bars(
    E: float, points: Float[np.ndarray, "point 2"], thickness: Float[np.ndarray, " point"], pitch: float
) -> tuple[Int[np.ndarray, "bar 3"], Float[np.ndarray, " bar"]]:
    """Bars of one sector of a wall of revolution.

    Parameters
    ----------
    E : float
        Young's modulus [Pa].
    points : array (point, 2)
        Mid-surface points (r, z) along the meridian [m].
    thickness : array (point,)
        Of the wall [m].
    pitch : float
        Angle of the sector [rad].

    Returns
    -------
    bars : array (bar, 3)
        First node, second node, and 1 where the second belongs to the next sector; node ``2 point + layer``.
    stiffness : array (bar,)
        [N/m], summed over the cells that a bar borders.
    """
    stiffness: dict[tuple[int, int, int], float] = {}

    def add(first: tuple[int, int, int], second: tuple[int, int, int], value: float) -> None:
        """A bar between (meridian point, layer, sector) and another."""
        if first[2]:
            first, second = second, first
        bar = (2 * first[0] + first[1], 2 * second[0] + second[1], second[2] - first[2])
        stiffness[bar] = stiffness.get(bar, 0.0) + value

    def connect(a: tuple[int, int], b: tuple[int, int], area: float, length: float, t: float) -> None:
        """The four bars between meridian points (point, sector) that replace plate material of E area / length."""
        # A crossing bar is longer than its projection onto the wall: L^2 / length^2 makes up for its inclination.
        inclined = (length**2 + t**2) / length**2
        for here, there in ((INNER, INNER), (OUTER, OUTER), (INNER, OUTER), (OUTER, INNER)):
            share = (1 - CROSSING) / 2 if here == there else CROSSING / 2 * inclined
            add((a[0], here, a[1]), (b[0], there, b[1]), share * E * area / length)

    for m in range(len(points) - 1):
        width = pitch * 0.5 * (points[m, 0] + points[m + 1, 0])
        height = float(np.linalg.norm(points[m + 1] - points[m]))
        t = 0.5 * (thickness[m] + thickness[m + 1])
        across, along, diagonal = (t * breadth for breadth in _plate_lattice(width, height))
        for point in (m, m + 1):
            connect((point, 0), (point, 1), 0.5 * across, pitch * points[point, 0], t)
            add((point, INNER, 0), (point, OUTER, 0), RIGID * E * width * height / t)
        connect((m, 0), (m + 1, 0), along, height, t)
        connect((m, 0), (m + 1, 1), diagonal, np.hypot(width, height), t)
        connect((m, 1), (m + 1, 0), diagonal, np.hypot(width, height), t)
    return np.array(list(stiffness)), np.array(list(stiffness.values()))


def _plate_lattice(a: float, b: float) -> tuple[float, float, float]:
    """Bar areas per wall thickness [m] of a cell a x b [m]: along a, along b, and of each diagonal.

    Energy equivalence with plane stress at Poisson's ratio 1/3, where C11 = 9/8 E and C12 = G = 3/8 E.
    """
    if not 1 / np.sqrt(3) < a / b < np.sqrt(3):
        raise ValueError(
            f"a cell of {a:.3e} m x {b:.3e} m is too oblong for a lattice (aspect ratio {a / b:.2f}, limits 0.58 and "
            "1.73): change the number of sectors"
        )
    c2, s2 = a**2 / (a**2 + b**2), b**2 / (a**2 + b**2)
    diagonal = 3 / (16 * c2 * s2) * a * b / np.hypot(a, b)
    return (9 - 3 * c2 / s2) / 8 * b, (9 - 3 * s2 / c2) / 8 * a, diagonal
