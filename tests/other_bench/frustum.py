"""Element of a thin shell of revolution: conical frustum, Kirchhoff-Love, fields exp(i n theta).

Strains of the middle surface and changes of curvature are Novozhilov's (The Theory of Thin Shells, 1959). Both nodes
have four degrees of freedom: axial, radial and circumferential displacement, and the slope of the normal one along the
meridian. Displacement in the middle surface is linear along the meridian, the normal one cubic.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float, Int


class Places(NamedTuple):
    """Places on the meridian, and what the 8 degrees of freedom of the element there do at them.

    Attributes
    ----------
    dof : array (place, 8)
        Numbers of the degrees of freedom.
    length : array (place,)
        Of the element [m].
    r : array (place,)
        Radius [m].
    v, w : array (place, 8)
        Circumferential and normal displacement, outward on a cylinder.
    B : array (power, place, 6, 8)
        Strains and changes of curvature (meridional, circumferential, shear each) as a polynomial of i n.
    """

    dof: Int[np.ndarray, "place 8"]
    length: Float[np.ndarray, " place"]
    r: Float[np.ndarray, " place"]
    v: Float[np.ndarray, "place 8"]
    w: Float[np.ndarray, "place 8"]
    B: Float[np.ndarray, "3 place 6 8"]

    def strains(self, n: int) -> Complex[np.ndarray, "place 6 8"]:
        """Strain matrices of order n."""
        return self.B[0] + 1j * n * self.B[1] - n * n * self.B[2]


def places(
    z: Float[np.ndarray, " node"], r: Float[np.ndarray, " node"], element: Int[np.ndarray, " place"],
    xi: Float[np.ndarray, " place"],
) -> Places:  # fmt: skip
    """Places at shares xi of the length of elements between consecutive nodes."""
    dz, dr = z[element + 1] - z[element], r[element + 1] - r[element]
    L = np.hypot(dz, dr)
    c, s = (dz / L)[:, None], (dr / L)[:, None]
    here = r[element] + dr * xi
    linear = np.stack([1 - xi, xi], axis=-1)
    slope = np.stack([-1 / L, 1 / L], axis=-1)
    u, u_s = (_spread(c * N, s * N) for N in (linear, slope))
    v, v_s = (_spread(circumferential=N) for N in (linear, slope))
    w, w_s, w_ss = (_spread(-s * H, c * H, slope=G) for H, G in _cubic(xi, L))
    rho = here[:, None]
    nothing = np.zeros_like(u)
    B = [
        [u_s, (c * w + s * u) / rho, v_s - s * v / rho, -w_ss, -s * w_s / rho, 2 * c * (v_s - s * v / rho) / rho],
        [nothing, v / rho, u / rho, nothing, c * v / rho**2, 2 * (s * w / rho - w_s) / rho],
        [nothing, nothing, nothing, nothing, -w / rho**2, nothing],
    ]
    return Places(4 * element[:, None] + np.arange(8), L, here, v, w, np.moveaxis(np.array(B), 1, 2))


def stiffness(E: float, nu: float, t: Float[np.ndarray, " place"]) -> Float[np.ndarray, "place 6 6"]:
    """Membrane forces and moments per strain and change of curvature of a plate of thickness t."""
    isotropic = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    membrane = E * t / (1 - nu**2)
    D = np.zeros((len(t), 6, 6))
    D[:, :3, :3] = membrane[:, None, None] * isotropic
    D[:, 3:, 3:] = (membrane * t**2 / 12)[:, None, None] * isotropic
    return D


def _cubic(
    xi: Float[np.ndarray, " place"], L: Float[np.ndarray, " place"]
) -> list[tuple[Float[np.ndarray, "place 2"], Float[np.ndarray, "place 2"]]]:
    """Hermite's cubics of displacement and slope of both nodes, and their first and second derivatives."""
    one = np.ones_like(xi)
    of_displacement = [
        [1 - 3 * xi**2 + 2 * xi**3, 3 * xi**2 - 2 * xi**3],
        [-6 * xi + 6 * xi**2, 6 * xi - 6 * xi**2],
        [-6 * one + 12 * xi, 6 * one - 12 * xi],
    ]
    of_slope = [
        [xi - 2 * xi**2 + xi**3, xi**3 - xi**2],
        [1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi],
        [-4 + 6 * xi, 6 * xi - 2],
    ]
    return [
        (np.array(H).T / L[:, None] ** k, np.array(G).T / L[:, None] ** (k - 1))
        for k, (H, G) in enumerate(zip(of_displacement, of_slope, strict=True))
    ]


def _spread(
    axial: np.ndarray | float = 0.0, radial: np.ndarray | float = 0.0, circumferential: np.ndarray | float = 0.0,
    slope: np.ndarray | float = 0.0,
) -> Float[np.ndarray, "place 8"]:  # fmt: skip
    """What each degree of freedom does, from arrays (place, node) for each kind of them."""
    kinds = np.stack(np.broadcast_arrays(axial, radial, circumferential, slope), axis=-1)
    return kinds.reshape(len(kinds), 8)
