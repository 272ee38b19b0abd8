"""Pictures of the chain: run-in, signals of every fault, influence maps, efficiency."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from swgsim.chain.chain import Run, simulate
from swgsim.chain.influence import influence_map
from swgsim.common import style
from swgsim.effects import Effect, RunIn
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.gear.stiffness import RATED_TORQUE, torsional_stiffness
from swgsim.storage.labelled_signals import SENSORS
from swgsim.studies import flexspline_figures
from swgsim.studies.examples import EXAMPLES, FIGURE_POINT, Subject

# Catalogue of a size 17, ratio 100 gear at rated torque and 2000 rpm: 77 +- 3 %; its losses need this b1.
CATALOGUE_EFFICIENCY, CATALOGUE_TOLERANCE, CATALOGUE_B1 = 0.77, 0.03, 0.254
CATALOGUE_POINT = OperatingPoint(2000, RATED_TORQUE)


def pictures(subject: Subject) -> list[style.Picture]:
    """All pictures of the chain, in the order of the paper's figures, then those that the paper lacks."""
    gear = subject.gears[0]
    n, T = FIGURE_POINT.n_in_rpm, FIGURE_POINT.T_out
    ours, catalogue = (eta for eta, _ in catalogue_comparison(subject).values())
    return [
        style.Picture(
            "Fig. 4: run-in",
            "Left: the stiffness that a bench measures at the output with the input locked falls within ten hours and "
            "stays. Right: the efficiency rises over 250 h, most at high speed and low load. Both follow from the "
            "effect RunIn, whose two losses are set to the paper's figures.",
            style.png(run_in(subject)),
        ),
        style.Picture(
            f"Fig. 6: healthy and faulty signals, gear {gear.number}, {n:g} rpm, {T:g} N m",
            "Left, as in the paper: (a), (b) and (e) coincide with the healthy signals to the eye, (c) moves s1 up and "
            "s3 down, (d) changes amplitudes. Right, on scales of their own: what remains of each fault in the "
            "signals. The faults are the severest of the grid.",
            style.png(signals(subject)),
        ),
        style.Picture(
            "The deformed flex spline",
            f"Displacements are magnified {flexspline_figures.MAGNIFICATION} times. The wave generator (black) presses "
            "two lobes into the open end; the collar below is clamped at its edge (green) and feels little of them, "
            "and this little is what the gauges on its back measure.",
            style.png(flexspline_figures.deformed(gear, subject.sectors)),
        ),
        style.Picture(
            "Layout of the gauges on the collar (Fig. 3)",
            "s1 to s4 are pairs of grids at 45 degrees to the radius, 90 degrees apart, so s1 and s3, s2 and s4 are "
            "opposite. s0 is one bridge of four such pairs in between, in which the two lobes cancel.",
            style.png(flexspline_figures.gauge_layout(gear)),
        ),
        style.Picture(
            "Influence maps: a signal is A(ψ) + T B(ψ)",
            "Above: the wave generator alone (A) and one N m of output torque (B); s0 is nearly constant in both, "
            "s1 to s4 go around twice per revolution. Below: what three faults change at s1. The eccentric wave "
            "generator shifts A and, through the load sharing, changes B; the root crack changes both, the tip crack B "
            "only, while a lobe is at the tooth.",
            style.png(influence_maps(subject)),
        ),
        style.Picture(
            "Efficiency over speed and load",
            "Left: efficiency falls with speed and rises with load. Right: look at the star, the catalogue's 77 +- 3 % "
            f"at {CATALOGUE_POINT.T_out:g} N m and {CATALOGUE_POINT.n_in_rpm:g} rpm. With the b1 of this gear (orange) "
            f"the chain gives {100 * ours:.1f} % there, with that of the catalogue's losses (blue) "
            f"{100 * catalogue:.1f} %.",
            style.png(efficiency(subject)),
        ),
    ]


def catalogue_gear(gear: Gear) -> Gear:
    """The gear with the linear damping that the catalogue's losses need."""
    return replace(gear, transmission=replace(gear.transmission, b1=CATALOGUE_B1))


def run_in(subject: Subject) -> Figure:
    """Fig. 4, and the efficiency of Table II between its two rows."""
    gear = subject.gears[0]
    early, late = np.linspace(0, 30, 61), np.linspace(0, 250, 26)
    stiffness = np.array([torsional_stiffness(RunIn(h).gear(gear).transmission) for h in early])
    runs = [Run(gear, point, (RunIn(h),)) for h in late for point in subject.points]
    efficiency = simulate(runs, subject.window, subject.sectors).efficiency.reshape(len(late), -1)
    picture = style.figure(9.5, 3.4)
    left, right = picture.subplots(1, 2)
    left.plot(early, stiffness / stiffness[0], color="#0072B2", linewidth=2)
    left.axhline(0.8, color="#D55E00", linestyle="--", label="paper: -20 %")
    left.axvline(10, color="#999999", linestyle=":", label="10 h")
    left.set_ylim(0.7, 1.02)
    left.legend()
    style.label(left, "operating time [h]", "stiffness k / k_nom [-]", "measured stiffness")
    right.plot(late, 100 * (efficiency / efficiency[0] - 1), color="#bbbbbb", linewidth=1)
    right.plot(late, 100 * (efficiency / efficiency[0] - 1).mean(axis=1), color="#0072B2", linewidth=2, label="mean")
    right.axhline(10, color="#D55E00", linestyle="--", label="paper: +10 % after 250 h")
    right.legend()
    style.label(right, "operating time [h]", "rise of the efficiency [%]", "efficiency (grey: each operating point)")
    return picture


def signals(subject: Subject) -> Figure:
    """Fig. 6, healthy and faulty signals, and their difference."""
    healthy, time = subject.examples["healthy"], 1e3 * subject.window.time
    picture = style.figure(11, 13)
    rows = picture.subplots(len(EXAMPLES), 2, sharex=True)
    for letter, (left, right), fault in zip("abcde", rows, EXAMPLES, strict=True):
        faulty = subject.examples[fault]
        for s, (name, colour) in enumerate(style.SENSOR_COLOURS.items()):
            left.plot(time, healthy[s], color=colour, linewidth=2.6, alpha=0.35)
            left.plot(time, faulty[s], color=colour, linewidth=1.1, linestyle="--", label=name)
            right.plot(time, 1e3 * (faulty[s] - healthy[s]), color=colour, linewidth=1.2, label=name)
        style.label(left, "", "signal [mV/V]", f"({letter}) {style.words(fault)}: healthy (broad), faulty (dashed)")
        style.label(right, "", "faulty - healthy [µV/V]", "difference, own scale")
    for axes in rows[-1]:
        axes.set_xlabel("time [ms]")
    picture.legend(*rows[0, 1].get_legend_handles_labels(), ncols=5, loc="outside upper center")
    return picture


def influence_maps(subject: Subject) -> Figure:
    """A and B over the wave-generator angle, and what three faults change in them at s1."""
    gear = subject.gears[0]
    flex = solve_flex_spline(gear.flex_spline, gear.transmission.alpha_tooth, subject.sectors)
    psi = np.linspace(0, 2 * np.pi, 361)
    degrees = np.rad2deg(psi)

    def maps(*effects: Effect) -> np.ndarray:
        return influence_map(flex, gear.wave_generator, gear.gauges, effects)(psi) * np.array([1, 1e3])[:, None, None]

    healthy = maps()
    picture = style.figure(11, 7)
    above, below = picture.subplots(2, 2, sharex=True)
    for axes, values in zip(above, healthy, strict=True):
        for name, value in zip(SENSORS, values, strict=True):
            axes.plot(degrees, value, color=style.SENSOR_COLOURS[name], label=name)
    for fault in ("eccentric_wave_generator", "root_tooth_crack", "tip_tooth_crack"):
        for axes, change in zip(below, maps(EXAMPLES[fault]) - healthy, strict=True):
            axes.plot(degrees, change[1], color=style.CLASS_COLOURS[fault], label=style.words(fault))
    style.label(above[0], "", "A [mV/V]", "wave generator: A, healthy")
    style.label(above[1], "", "B [µV/V per N m]", "output torque: B, healthy")
    x = "wave-generator angle ψ [degrees]"
    style.label(below[0], x, "change of A [mV/V]", "what a fault changes in A at s1")
    style.label(below[1], x, "change of B [µV/V per N m]", "what a fault changes in B at s1")
    below[0].set_xticks(range(0, 361, 45))
    picture.legend(*above[0].get_legend_handles_labels(), ncols=5, loc="outside upper center")
    below[0].legend(fontsize=8)
    return picture


def efficiency(subject: Subject) -> Figure:
    """Efficiency over speed and load, and against the catalogue."""
    gear = subject.gears[0]
    speeds, loads = np.linspace(1200, 4500, 8), np.geomspace(4, 70, 18)
    grid = [Run(gear, OperatingPoint(n, T)) for T in loads for n in speeds]
    curves = [Run(g, OperatingPoint(n, T)) for g in (gear, catalogue_gear(gear)) for n in (2000, 4000) for T in loads]
    eta = 100 * simulate([*grid, *curves], subject.window, subject.sectors).efficiency
    picture = style.figure(11, 4.3)
    left, right = picture.subplots(1, 2)
    field = eta[: len(grid)].reshape(len(loads), len(speeds))
    filled = left.contourf(speeds, loads, field, levels=range(20, 91, 5), cmap="cividis")
    lines = left.contour(speeds, loads, field, levels=range(20, 91, 10), colors="white", linewidths=0.8)
    left.clabel(lines, fmt="%d %%", fontsize=8)
    picture.colorbar(filled, ax=left, label="efficiency [%]")
    left.plot([p.n_in_rpm for p in subject.points], [p.T_out for p in subject.points], "o", color="#E69F00",
              markeredgecolor="black", label="the paper's operating points", clip_on=False, zorder=5)  # fmt: skip
    left.plot(CATALOGUE_POINT.n_in_rpm, CATALOGUE_POINT.T_out, "*", color="white", markeredgecolor="black",
              markersize=14, label="catalogue point")  # fmt: skip
    picture.legend(*left.get_legend_handles_labels(), fontsize=8, ncols=2, loc="outside lower left")
    style.label(left, "input speed [rpm]", "output torque [N m]", f"this gear, b1 = {gear.transmission.b1:g} N m s/rad")
    styles = [("#D55E00", "-", gear, 2000), ("#D55E00", "--", gear, 4000),
              ("#0072B2", "-", catalogue_gear(gear), 2000), ("#0072B2", "--", catalogue_gear(gear), 4000)]  # fmt: skip
    for (colour, dash, each, n), curve in zip(styles, eta[len(grid) :].reshape(4, -1), strict=True):
        right.plot(loads, curve, color=colour, linestyle=dash, label=f"b1 = {each.transmission.b1:g}, {n} rpm")
    right.errorbar(RATED_TORQUE, 100 * CATALOGUE_EFFICIENCY, 100 * CATALOGUE_TOLERANCE, fmt="k*", markersize=11,
                   capsize=4, label="catalogue, 2000 rpm")  # fmt: skip
    right.legend(fontsize=8)
    style.label(right, "output torque [N m]", "efficiency [%]", "against the catalogue")
    return picture


def catalogue_comparison(subject: Subject) -> dict[str, tuple[float, float]]:
    """Efficiency at the catalogue point and no-load running torque at its speed [N m], per value of b1."""
    gear = subject.gears[0]
    idle = OperatingPoint(CATALOGUE_POINT.n_in_rpm, 0)
    result = {}
    for each in (gear, catalogue_gear(gear)):
        simulation = simulate([Run(each, CATALOGUE_POINT), Run(each, idle)], subject.window, subject.sectors)
        idle_torque = simulation.motion.T_in[simulation.of_run[1]].mean()
        result[f"{each.transmission.b1:g}"] = (float(simulation.efficiency[0]), float(idle_torque))
    return result
