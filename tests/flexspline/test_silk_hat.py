"""The lattice of the flex spline: rigid bodies, plates in closed form, bad meshes."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS, flex_spline

from swgsim.flexspline.flexspline import TEETH, gauge_response
from swgsim.flexspline.silk_hat import SilkHat, sector


def test_six_rigid_body_modes_and_no_mechanism() -> None:
    truss = sector(replace(SilkHat(), fillet=3e-3, clamp_radius=45e-3), 24).truss()
    stiffness = truss.matrix.toarray()
    values = np.linalg.eigvalsh(stiffness / np.abs(stiffness).max())
    assert np.sum(values < 1e-10) == 6
    turned = np.cross([0.3, -0.2, 0.9], truss.nodes) + np.array([1.0, 2.0, 3.0])
    assert np.abs(stiffness @ turned.ravel()).max() < 1e-9 * np.abs(stiffness).max()


def test_torsion_of_the_collar_in_closed_form() -> None:
    """The shear strain of a disc under torque is T / (2 pi r^2 t G), with G = 3 E / 8 of the lattice."""
    hat, gauges = GEAR.flex_spline, GEAR.gauges
    flex = flex_spline(100)
    unit_torque = 1 / flex.tooth_radius / flex.sector.count
    signal = gauge_response(flex, gauges)[0, 1, TEETH].real * unit_torque
    shear = 1 / (2 * np.pi * gauges.radius**2 * hat.collar * 3 / 8 * hat.E)
    assert signal == pytest.approx(1e3 * gauges.gauge_factor / 4 * shear, rel=5e-3)


def test_membrane_and_bending_stiffness_of_the_plate() -> None:
    """A uniform stretch and a uniform curvature of the wall store the energy of a plate with nu = 1/3."""
    hat = replace(SilkHat(), wall=0.8e-3)
    count = 200
    piece = sector(hat, count)
    truss = piece.truss()
    radius = np.hypot(*truss.nodes[:, :2].T)
    sleeve = np.flatnonzero(np.tile(piece.nodes[:, 2] > hat.fillet, count))
    inside = np.isin(truss.bars, sleeve).all(axis=1)
    height = piece.nodes[:, 2].max() - piece.nodes[piece.nodes[:, 2] > hat.fillet, 2].min()
    area = 2 * np.pi * hat.radius * height

    def energy(u: np.ndarray) -> float:
        return 0.5 * float(truss.stiffness[inside] @ ((truss.elongation @ u.ravel())[inside] ** 2))

    # Axial stretch without radial motion: E t / (1 - nu^2) = 9/8 E t.
    stretch = 1e-6 * truss.nodes * [0, 0, 1]
    assert energy(stretch) == pytest.approx(0.5 * 9 / 8 * hat.E * hat.wall * area * 1e-12, rel=0.03)

    # Axial curvature, walls tilting with it: E t^3 / 12 / (1 - nu^2).
    curvature = 1e-3
    tilt = curvature * truss.nodes[:, 2]
    outwards = truss.nodes * [1, 1, 0] / radius[:, None]
    bend = -0.5 * curvature * truss.nodes[:, 2:] ** 2 * outwards
    bend += np.stack([0 * tilt, 0 * tilt, tilt * (radius - hat.radius)], axis=1)
    plate = 0.5 * 9 / 8 * hat.E * hat.wall**3 / 12 * area * curvature**2
    membrane = 0.5 * 9 / 8 * hat.E * hat.wall * 2 * np.pi * hat.radius
    z = np.linspace(piece.nodes[piece.nodes[:, 2] > hat.fillet, 2].min(), hat.length, 2001)
    membrane *= np.trapezoid((0.5 * curvature * z**2 / hat.radius) ** 2, z)
    assert energy(bend) == pytest.approx(plate + membrane, rel=0.03)


@pytest.mark.parametrize(("count", "rule"), [(41, "even"), (22, "from 24 to"), (0, "from 24 to"), (-10, "from 24 to")])
def test_odd_or_too_few_sectors_are_refused(count: int, rule: str) -> None:
    with pytest.raises(ValueError, match=f"sectors of the mesh is {count}, must be .*{rule}"):
        sector(SilkHat(), count)


def test_oblong_cells_are_refused() -> None:
    with pytest.raises(ValueError, match="too oblong"):
        sector(replace(SilkHat(), fillet=0.3e-3), 40)


@pytest.mark.parametrize("name", ["radius", "wall", "E"])
def test_dimensions_must_be_positive(name: str) -> None:
    with pytest.raises(ValueError, match=f"{name} of the flex spline is -1"):
        replace(SilkHat(), **{name: -1.0})


def test_gauges_must_be_on_the_collar() -> None:
    with pytest.raises(ValueError, match="must be on the collar"):
        gauge_response(flex_spline(SECTORS), replace(GEAR.gauges, radius=0.02))
