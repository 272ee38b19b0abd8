"""Pictures of the answer: the residual before and after, the scores, the errors, the parameters.

The residual is measured minus predicted, by the chain at the reported parameters. Nuisance parameters, such as zeros
and gains of a session, are estimated and subtracted.
"""

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.common.numbers import NORMAL
from swgsim.identification.data.features import ORDERS, basis
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.errors import repeat_noise
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.effect_words import plain_title
from swgsim.identification.report.prediction_errors import WHAT
from swgsim.identification.search.screening import ALPHA
from swgsim.recordings.recording import CHANNELS
from swgsim.storage.labelled_signals import SENSORS

BEFORE, AFTER, FLOOR, GREY = "#D55E00", "#0072B2", "#000000", "#bbbbbb"
CURVE_POINTS = 360
# Bars of the picture of probabilities, at most.
MOST_BARS = 6


def pictures(answer: Answer, report: Mapping[str, Any]) -> dict[str, style.Picture]:
    """All pictures by their names.

    Parameters
    ----------
    answer : Answer
    report : mapping
        As :func:`swgsim.identification.report.report_fields.report` makes it.
    """
    found = bool(report["effects"])
    drawn = {
        "residual": (
            "Measured minus predicted over one revolution",
            ("Orange: the model without the effect. Blue: with it. " if found else "")
            + "Grey band: noise (two standard deviations). The picture shows the channel and the operating point with "
            "the largest residual, as the mean of the repeats.",
            over_angle(answer, largest_only=True),
        ),
        "posterior": (
            "Probability of each explanation",
            "Posterior probabilities. The dark bars together have at least 95 %. "
            + (
                "What would separate them is listed under What to do next."
                if len(report["alternatives"]) > 1
                else "No other explanation of the library is nearly as probable."
            ),
            posterior(report),
        ),
        "residual_over_angle": (
            "Residual over one revolution of the wave generator",
            "Measured minus predicted, as the mean of the repeats at the operating point with the largest residual. "
            "Zeros of the session and other nuisance parameters are estimated and subtracted. Grey band: two standard "
            "deviations of noise and of the errors of single recordings.",
            over_angle(answer),
        ),
        "residual_spectrum": (
            "Residual over the orders of the wave generator",
            "Root mean square of every order line over all recordings. Where blue reaches the noise floor from the "
            "repeats (black line), the model explains the recordings completely. Order 0 is the mean of the channel.",
            spectrum(answer),
        ),
        "scores": (
            "Score of every effect of the library in the first search",
            "Reduction of the residual's sum of squares by each effect, in units of the noise, with nuisance "
            "parameters marginalised. Orange: significant in a search of the whole library. Grey names: absorbed, "
            "these recordings cannot test the effect. Similar effects have similar scores; the posterior decides "
            "between them.",
            scores(report),
        ),
        "errors": (
            "Error before and after",
            "Errors of fitted recordings, of left-out repeats and of left-out operating points, relative to the root "
            "mean square of the channel. Black lines: noise floor from the repeats.",
            errors(report),
        ),
    }
    if answer.decision.after.declared:
        drawn["parameters"] = (
            "Declared parameters",
            "Deviation from the nominal value in units of the spread of a series, with 95 % intervals. Parameters with "
            "orange names moved by more than two standard deviations when the effect was added.",
            parameters(answer, report),
        )
    return {name: style.Picture(title, caption, style.png(figure)) for name, (title, caption, figure) in drawn.items()}


def posterior(report: Mapping[str, Any]) -> Figure:
    """Probabilities of the answers of the credible set, and of all others together."""
    bars = [(each["words"], each["probability"], AFTER) for each in report["alternatives"][:MOST_BARS]]
    bars.append(("all others", max(0.0, 1.0 - sum(each[1] for each in bars)), GREY))
    picture = style.figure(5.6, 0.6 + 0.32 * len(bars))
    axes = picture.subplots()
    names, values, colours = zip(*reversed(bars), strict=True)
    axes.barh(range(len(bars)), values, color=colours)
    axes.set_yticks(range(len(bars)), [fill(name, 44) for name in names], fontsize=8)
    axes.set_xlim(0, 1)
    style.label(axes, "probability", "")
    return picture


def over_angle(answer: Answer, *, largest_only: bool = False) -> Figure:
    """Residual of every gauge over the angle, before and after; of the other channels if there is no gauge.

    Parameters
    ----------
    answer : Answer
    largest_only : bool
        Draw only the channel with the largest residual.
    """
    before, after = answer.decision.before, answer.decision.after
    measured = before.measured
    channels = measured.layout.channels
    shown = [i for i, name in enumerate(channels) if name in SENSORS] or list(range(len(channels)))
    rows = worst(before, after)
    if largest_only:
        square = _white(before, after)[rows].mean(axis=0) ** 2
        shown = [max(shown, key=lambda i: float(_of_channel(square, i).sum()))]
    psi = np.linspace(0, 2 * np.pi, CURVE_POINTS)
    noise = _of_mean(before, rows)
    picture = style.figure(5.6, 3.2) if largest_only else style.figure(11, 2.1 * len(shown))
    all_axes = np.atleast_1d(picture.subplots(len(shown), 1, sharex=True))
    for axes, i in zip(all_axes, shown, strict=True):
        band = 2 * np.linalg.norm(basis(psi, ORDERS) @ _of_channel(noise, i), axis=1)
        axes.fill_between(np.rad2deg(psi), -band, band, color="#dddddd", label="noise")
        for fitted, colour, name in ((before, BEFORE, "before"), (after, AFTER, "after")):
            mean = (fitted.residual - after.nuisance).reshape(measured.values.shape)[rows].mean(axis=0)
            axes.plot(np.rad2deg(psi), basis(psi, ORDERS) @ _of_channel(mean, i), color=colour, label=name)
        style.label(axes, "", f"{channels[i]} [{CHANNELS[channels[i]].unit}]")
    point = measured.recordings[rows[0]].point
    all_axes[0].set_title(f"{point.n_in_rpm:g} rpm, {point.T_out:g} N m", loc="left", fontsize=10)
    all_axes[-1].set_xlabel("angle of the wave generator [degrees]")
    all_axes[-1].set_xticks(range(0, 361, 45))
    picture.legend(*all_axes[0].get_legend_handles_labels(), ncols=3, loc="outside upper center")
    return picture


def worst(fitted: Fitted, after: Fitted) -> list[int]:
    """The recordings of the operating point with the largest residual, in units of the noise."""
    measured, white = fitted.measured, _white(fitted, after)
    gauges = measured.layout.of_gauges
    size = (white[:, gauges if gauges.any() else slice(None)] ** 2).sum(axis=1)
    points = [recording.point for recording in measured.recordings]
    groups = [[i for i, each in enumerate(points) if each == point] for point in dict.fromkeys(points)]
    return max(groups, key=lambda rows: float(size[rows].mean()))


def _white(fitted: Fitted, after: Fitted) -> Float[np.ndarray, "recording feature"]:
    """The residual in standard deviations of the noise, without nuisance parameters."""
    white = (fitted.residual - after.nuisance) / np.sqrt(fitted.errors.variance)
    return white.reshape(fitted.measured.values.shape)


def _of_mean(fitted: Fitted, rows: Sequence[int]) -> Float[np.ndarray, "feature column"]:
    """Errors of single recordings in the mean of some of them, one standard deviation per column."""
    measured = fitted.measured
    white = np.diag(np.sqrt(measured.variance[rows].mean(axis=0) / len(rows)))
    return np.hstack([white, *fitted.errors.alone.C[rows] / len(rows)])


def _of_channel(features: np.ndarray, i: int) -> np.ndarray:
    """The rows of one channel, of an array (feature,) or (feature, column)."""
    return features.reshape(-1, 2 * ORDERS + 1, *features.shape[1:])[i]


def spectrum(answer: Answer) -> Figure:
    """Residual of every order line of every channel before and after, with the noise floor as a line."""
    before, after = answer.decision.before, answer.decision.after
    measured = before.measured
    channels = measured.layout.channels
    rows = -(-len(channels) // 2)
    picture = style.figure(11, 2.3 * rows)
    panels = picture.subplots(rows, 2, sharex=True, squeeze=False).ravel()
    orders = np.arange(ORDERS + 1)
    floor = repeat_lines(measured)
    for i, (axes, name) in enumerate(zip(panels, channels, strict=False)):
        for fitted, colour, label, side in ((before, BEFORE, "before", -0.2), (after, AFTER, "after", 0.2)):
            residual = (fitted.residual - after.nuisance).reshape(measured.values.shape)
            axes.bar(orders + side, lines(measured, residual)[i], 0.4, color=colour, label=label)
        if floor is not None:
            axes.step(orders, floor[i], where="mid", color=FLOOR, linewidth=1.6, label="noise floor by repeats")
        axes.set_yscale("log")
        style.label(axes, "", f"{name} [{CHANNELS[name].unit}]")
    for axes in panels[len(channels) :]:
        axes.set_visible(False)
    for axes in panels[max(len(channels) - 2, 0) : len(channels)]:
        axes.set_xlabel("order of the wave generator")
        axes.tick_params(labelbottom=True)
    picture.legend(*panels[0].get_legend_handles_labels(), ncols=3, loc="outside upper center")
    return picture


def lines(measured: Measured, rows: Float[np.ndarray, "recording feature"]) -> Float[np.ndarray, "channel order"]:
    """Root mean square over recordings of the size of every order line."""
    return np.sqrt((np.abs(measured.layout.lines(rows)) ** 2).mean(axis=0))


def repeat_lines(measured: Measured) -> Float[np.ndarray, "channel order"] | None:
    """Noise of every order line from the repeats; None without repeats."""
    noise = repeat_noise(measured)
    return None if noise is None else lines(measured, noise)


def scores(report: Mapping[str, Any]) -> Figure:
    """Score of every effect: significant ones orange, names of absorbed ones grey."""
    absorbed = {each["name"] for each in report["absorbed"]}
    found = [score for score in report["scores"] if score["name"] not in absorbed]
    found = sorted(found, key=lambda score: score["score"])
    names = sorted(absorbed, reverse=True) + [score["name"] for score in found]
    picture = style.figure(9.5, 1.0 + 0.19 * len(names))
    axes = picture.subplots()
    shortest = 0.1
    for place in range(len(absorbed)):
        axes.text(shortest * 1.15, place, "cannot be tested", color="#777777", fontsize=7, va="center")
    for place, score in enumerate(found, len(absorbed)):
        colour = BEFORE if score["chance"] <= ALPHA else "#56B4E9"
        axes.barh(place, max(score["score"], shortest) - shortest, left=shortest, color=colour, height=0.75)
    axes.set_yticks(range(len(names)), [plain_title(name) for name in names], fontsize=7.5)
    for place, tick in enumerate(axes.get_yticklabels()):
        tick.set_color(GREY if place < len(absorbed) else "#000000")
    axes.set_xscale("log")
    axes.set_xlim(left=shortest)
    axes.set_ylim(-0.7, len(names) - 0.3)
    style.label(axes, "score: reduction of the sum of squares [noise variance]", "")
    return picture


def errors(report: Mapping[str, Any]) -> Figure:
    """Error of every channel before and after, of what was fitted and left out, with the noise floor as a line."""
    per_channel = report["error"]["per_channel"]
    picture = style.figure(12, 3.8)
    panels = picture.subplots(1, len(WHAT), sharey=True)
    titles = ("fitted recordings", "left-out repeats", "left-out operating points")
    for axes, what, title in zip(panels, WHAT, titles, strict=True):
        for i, each in enumerate(per_channel.values()):
            share = 100 / each["root_mean_square"]
            for when, colour, side in (("before", BEFORE, -0.2), ("after", AFTER, 0.2)):
                if each[when][what] is not None:
                    label = when if i == 0 else None
                    axes.bar(i + side, share * each[when][what], 0.4, color=colour, label=label)
            if each["noise_floor"] is not None:
                label = "noise floor" if i == 0 else None
                height = share * each["noise_floor"]
                axes.hlines(height, i - 0.45, i + 0.45, color=FLOOR, linewidth=2, label=label)
        if all(each["before"][what] is None for each in per_channel.values()):
            axes.text(0.5, 0.5, "no recording can be left out", ha="center", transform=axes.transAxes)
        axes.set_xticks(range(len(per_channel)), list(per_channel), fontsize=8)
        style.label(axes, "", "error [% of the root mean square]" if what == "fit" else "", title)
        axes.set_yscale("log")
    picture.legend(*panels[0].get_legend_handles_labels(), ncols=3, loc="outside upper center")
    return picture


def parameters(answer: Answer, report: Mapping[str, Any]) -> Figure:
    """Declared parameters before and after with their intervals."""
    before, after = answer.decision.before, answer.decision.after
    names = list(after.declared)
    picture = style.figure(9.5, 1.0 + 0.24 * len(names))
    axes = picture.subplots()
    rows = np.arange(len(names))[::-1]
    for fitted, colour, label, side in ((before, BEFORE, "before", 0.17), (after, AFTER, "after", -0.17)):
        centre = [fitted.calibrated.position[name] for name in names]
        half = [NORMAL * fitted.deviation[name] / fitted.parameters[name].sd for name in names]
        axes.errorbar(centre, rows + side, xerr=half, fmt="o", markersize=4, color=colour, capsize=2, label=label)
    axes.axvline(0, color=GREY)
    axes.set_yticks(rows, names, fontsize=8)
    for name, tick in zip(names, axes.get_yticklabels(), strict=True):
        tick.set_color(BEFORE if name in report["moved"] else "#000000")
    axes.legend(fontsize=8)
    style.label(axes, "deviation from the nominal value [spread of a series]", "")
    return picture
