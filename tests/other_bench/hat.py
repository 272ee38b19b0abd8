"""Flex spline as a silk hat: a sleeve with the toothed band near its open end, and a collar clamped at its edge."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float


@dataclass(frozen=True)
class Hat:
    """Dimensions and mesh of the middle surface; the corner between sleeve (z < 0) and collar (z = 0) is sharp.

    Size 17, ratio 100 (physics.md section 2.3); length, free end, collar and clamp are estimates, as is how much teeth
    stiffen the wall in bending and stretching.

    Attributes
    ----------
    R, length, wall : float
        Of the sleeve [m].
    free, band : float
        Sleeve beyond the band, and width of the band under the wave generator [m].
    tooth_stiffening : float
        Thickness of the band over the wall's.
    clamp, collar : float
        Radius of the clamped edge, thickness [m].
    gauge_radius, grid : float
        Where the gauges sit on the collar's back, side of their square grids [m].
    E, nu : float
        Steel [Pa], [-].
    sleeve_elements, collar_elements : int
    """

    R: float = 21.2e-3
    length: float = 25.4e-3
    wall: float = 0.43e-3
    free: float = 0.3e-3
    band: float = 11e-3
    tooth_stiffening: float = 1.15
    clamp: float = 31e-3
    collar: float = 0.8e-3
    gauge_radius: float = 28e-3
    grid: float = 3e-3
    E: float = 209e9
    nu: float = 0.295
    sleeve_elements: int = 50
    collar_elements: int = 36

    @cached_property
    def z(self) -> Float[np.ndarray, " node"]:
        """Axial place of the nodes [m]."""
        return np.concatenate([np.linspace(-self.length, 0, self.sleeve_elements + 1), np.zeros(self.collar_elements)])

    @cached_property
    def r(self) -> Float[np.ndarray, " node"]:
        """Radius of the nodes [m]."""
        sleeve = np.full(self.sleeve_elements, self.R)
        return np.concatenate([sleeve, np.linspace(self.R, self.clamp, self.collar_elements + 1)])

    @property
    def in_band(self) -> Bool[np.ndarray, " element"]:
        """Elements whose middle lies in the band."""
        beyond = (self.z[1:] + self.z[:-1]) / 2 + self.length - self.free
        return (beyond > 0) & (beyond < self.band)

    @property
    def thickness(self) -> Float[np.ndarray, " element"]:
        """Of the elements [m]."""
        sleeve = np.where(self.in_band, self.wall * self.tooth_stiffening, self.wall)
        return np.where(np.arange(len(sleeve)) < self.sleeve_elements, sleeve, self.collar)
