"""Pictures of the flex spline: its deformed shape and the layout of its gauges."""

import matplotlib as mpl
import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Ellipse

from swgsim.chain.influence import boundary_conditions, ellipse, fine_angles
from swgsim.common import style
from swgsim.flexspline.cyclic import order_weights
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.flexspline.gauges import LAYOUT
from swgsim.flexspline.lattice import OUTER
from swgsim.flexspline.silk_hat import sector
from swgsim.gear.gear import Gear
from swgsim.storage.labelled_signals import SENSORS

MAGNIFICATION = 15
TORQUE = 70.0


def displacement(gear: Gear, sectors: int) -> Float[np.ndarray, "sector node 3"]:
    """Nodal displacements (radial, circumferential, axial) [m] under the wave generator at psi = 0 and full load."""
    flex = solve_flex_spline(gear.flex_spline, gear.transmission.alpha_tooth, sectors)
    psi = np.zeros(1)
    cam = ellipse(gear.wave_generator, gear.flex_spline.radius, psi, fine_angles(sectors))
    radial, forces = boundary_conditions(flex, cam, (), psi)
    loads = np.stack([radial[0], TORQUE * forces[0]], axis=1)  # in the order WAVE_GENERATOR, TEETH
    return flex.displacement(np.fft.rfft(loads, axis=0) / sectors, order_weights(sectors))


def deformed(gear: Gear, sectors: int) -> Figure:
    """The flex spline under wave generator and full load, displacements magnified, colour by radial displacement."""
    hat, whole = gear.flex_spline, sector(gear.flex_spline, sectors)
    moved = displacement(gear, sectors)
    outer = whole.layer(OUTER)
    u = np.concatenate([moved, moved[:1]])[:, outer]  # (sector, meridian, rtz), closed
    r, _, z = whole.nodes[outer].T
    angle = np.linspace(0, 2 * np.pi, sectors + 1)[:, None] + MAGNIFICATION * u[..., 1] / r
    radius, height = 1e3 * (r + MAGNIFICATION * u[..., 0]), 1e3 * (z + MAGNIFICATION * u[..., 2])
    x, y = radius * np.cos(angle), radius * np.sin(angle)

    picture = style.figure(8.5, 6.6)
    axes = picture.add_subplot(projection="3d", computed_zorder=False)
    limit = 1e6 * gear.wave_generator.w0
    scale = mpl.cm.ScalarMappable(mpl.colors.Normalize(-limit, limit), "RdBu_r")
    axes.plot_surface(x, y, height, facecolors=scale.to_rgba(1e6 * u[..., 0]), rstride=1, cstride=1, shade=False,
                      edgecolor="#00000022", linewidth=0.2, zorder=2)  # fmt: skip
    around = np.linspace(0, 2 * np.pi, 181)
    lobes = ellipse(gear.wave_generator, hat.radius, np.zeros(1), around)[0]
    rim = 1e3 * (hat.radius - hat.wall + MAGNIFICATION * lobes)
    axes.plot(rim * np.cos(around), rim * np.sin(around), 1e3 * hat.length + 0.3, color="black", linewidth=2.5,
              label="wave generator", zorder=3)  # fmt: skip
    axes.plot(x[:, -1], y[:, -1], height[:, -1], color="#009E73", linewidth=3,
              label="clamped edge of the collar", zorder=1)  # fmt: skip
    axes.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]")
    axes.set_aspect("equal")
    axes.view_init(elev=32, azim=-62)
    axes.legend(loc="upper left")
    picture.colorbar(scale, ax=axes, shrink=0.6, pad=0.08, label="radial displacement [µm]")
    return picture


def gauge_layout(gear: Gear) -> Figure:
    """Positions of the grids of the five bridges on the back of the collar (Fig. 3)."""
    hat, gauges = gear.flex_spline, gear.gauges
    picture = style.figure(6.4, 6.2)
    axes = picture.add_subplot()
    for radius, fill in ((hat.clamp_radius, "#e8e8e8"), (hat.radius + hat.fillet, "white")):
        axes.add_patch(Circle((0, 0), 1e3 * radius, facecolor=fill, edgecolor="#666666"))
    axes.add_patch(Ellipse((0, 0), 39, 34, facecolor="#f4f4f4", edgecolor="#999999", linestyle="--"))
    axes.text(0, 0, "wave generator\n(ellipse exaggerated)\nat ψ = 0", ha="center", va="center", color="#666666")
    for s, name in enumerate(SENSORS):
        for number, angle in enumerate(LAYOUT[s] + gauges.position[s]):
            _grid_pair(axes, angle, 1e3 * gauges.radius, style.SENSOR_COLOURS[name], name if number == 0 else "")
            out = 1e3 * hat.clamp_radius + 2.2
            axes.text(out * np.cos(angle), out * np.sin(angle), name, ha="center", va="center", fontsize=12,
                      color=style.SENSOR_COLOURS[name], weight="bold")  # fmt: skip
    axes.set_aspect("equal")
    axes.set(xlim=(-36, 36), ylim=(-36, 36))
    style.label(axes, "x [mm]", "y [mm]", "back of the collar")
    return picture


def _grid_pair(axes: mpl.axes.Axes, angle: float, radius: float, colour: str, name: str) -> None:
    """Two grids at +-45 degrees to the radius, each of three strokes."""
    centre = radius * np.array([np.cos(angle), np.sin(angle)])
    tangent = np.array([-np.sin(angle), np.cos(angle)])
    for side in (-1, 1):
        slant = angle + side * np.pi / 4
        along, across = np.array([np.cos(slant), np.sin(slant)]), np.array([-np.sin(slant), np.cos(slant)])
        for stroke in (-0.5, 0, 0.5):
            middle = centre + 1.7 * side * tangent + stroke * across
            ends = np.stack([middle - 1.2 * along, middle + 1.2 * along])
            axes.plot(*ends.T, color=colour, linewidth=1.8, label=name if name and side == 1 and not stroke else None)


if __name__ == "__main__":
    import sys
    from pathlib import Path

    from swgsim.chain.chain import SECTORS

    Path(sys.argv[1]).write_bytes(style.png(deformed(Gear(), SECTORS)))
