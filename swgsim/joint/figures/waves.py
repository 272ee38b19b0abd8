"""Picture: amplitude and phase of the ripples, measured in each recording and modelled."""

from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swgsim.common import style
from swgsim.joint.effects.ripple import InertiaRipple, Ripple
from swgsim.joint.figures.parts import WIDTH, face, logarithmic, pieces, session_key, sessions, tables, unit
from swgsim.joint.naming import part_of
from swgsim.joint.recording import JointRecording
from swgsim.joint.term import Term
from swgsim.joint.validation import Validation

# Largest number of orders; those with the largest gain are shown.
MOST_ORDERS = 9
# Least waves in a stretch, and highest frequency as a share of the sampling rate.
LEAST_WAVES, HIGHEST_SHARE = 1.0, 0.45
# Distances of the neighbouring orders that give the noise, in resolutions of the stretch.
NOISE_DISTANCES = (-5, -4, -3, -2, 2, 3, 4, 5)
# Least amplitude for a phase, in units of the noise.
CLEAR = 2.0
# Least range of the phase axis [degrees].
LEAST_PHASE = 90.0
# Least range of the frequency axis, in its natural logarithm: a factor of 10.
LEAST_DECADE = 2.3


@dataclass(frozen=True)
class RippleEstimate:
    """An order in a stretch: frequency [Hz], complex amplitude, noise, session, whether held out."""

    frequency: float
    value: complex
    noise: float
    session: str
    heldout: bool


def waves(validation: Validation) -> Figure | None:
    """Amplitude and phase of the ripples over their frequency; None without a visible ripple."""
    steps = sorted(validation.ladder.steps, key=lambda step: -step.gain)
    orders = list(dict.fromkeys(step.term.order for step in steps if _of_speed(step.term)))[:MOST_ORDERS]
    measured = {order: ripple_estimates(validation, order) for order in sorted(orders)}
    measured = {order: points for order, points in measured.items() if points}
    if not measured:
        return None
    picture = style.figure(WIDTH, 3.8 * len(measured) + 0.6)
    panels = picture.subplots(2 * len(measured), 1, height_ratios=[1.15, 1.0] * len(measured)).reshape(-1, 2)
    for (above, below), (order, points) in zip(panels, measured.items(), strict=True):
        _draw(above, below, validation, order, points)
    session_key(picture, validation)
    return picture


def modelled(validation: Validation, order: float, omega: np.ndarray) -> np.ndarray:
    """Complex amplitude of an order in the model at speeds [rad/s], such that the signal is its real part times
    exp(1j order q).
    """
    terms = _at(validation, order)
    return sum(((t.weights[0] - 1j * t.weights[1]) * t.response(omega) for t in terms), np.zeros(len(omega), complex))


def _of_speed(term: Term) -> TypeGuard[Ripple]:
    """Whether a term is a ripple whose amplitude and phase depend on the speed only."""
    return isinstance(term, Ripple) and not isinstance(term, InertiaRipple)


def _at(validation: Validation, order: float) -> list[Ripple]:
    return [each for each in validation.ladder.top.terms if _of_speed(each) and each.order == order]


def ripple_estimates(validation: Validation, order: float) -> list[RippleEstimate]:
    """An order in all recordings, by least squares on the residual of all other terms."""
    found = []
    for table, heldout in tables(validation):
        terms = _at(validation, order)
        rest = validation.ladder.top.missed(table) + sum(table.columns(term) @ np.array(term.weights) for term in terms)
        for number, each in enumerate(table.recordings):
            own = rest[table.run == number]
            for chosen in pieces(each):
                point = _point(each, own, chosen, order)
                if point is not None:
                    speed, value, noise = point
                    base = complex(modelled(validation, order, np.array([abs(speed)]))[0])
                    if speed < 0 and base:
                        # A lag has the opposite sign: the phase is mirrored about that of the wave.
                        itself = sum(t.weights[0] - 1j * t.weights[1] for t in terms)
                        value = itself * np.conj(value / itself)
                    found.append(RippleEstimate(order * abs(speed) / (2 * np.pi), value, noise, each.session, heldout))
    return found


def _point(
    recording: JointRecording, rest: np.ndarray, chosen: np.ndarray, order: float
) -> tuple[float, complex, float] | None:
    """Mean speed, complex amplitude and noise of an order in a stretch; None if it has too few waves."""
    q, speed = recording.signals["q"][chosen], float(recording.speed[chosen].mean())
    way = abs(speed) * chosen.sum() / recording.rate
    if order * way < LEAST_WAVES * 2 * np.pi or order * abs(speed) > HIGHEST_SHARE * 2 * np.pi * recording.rate:
        return None
    resolution = 2 * np.pi / float(np.ptp(q))
    neighbours = [order + place * resolution for place in NOISE_DISTANCES if order + place * resolution > 0]
    noise = float(np.median([abs(_fitted(q, rest[chosen], each)) for each in neighbours]))
    return speed, _fitted(q, rest[chosen], order), noise


def _fitted(q: np.ndarray, signal: np.ndarray, order: float) -> complex:
    """Complex amplitude of a wave, fitted together with a constant."""
    columns = np.stack([np.cos(order * q), np.sin(order * q), np.ones(len(q))], axis=1)
    a, b, _ = np.linalg.lstsq(columns, signal)[0].tolist()
    return complex(a, -b)


def _draw(above: Axes, below: Axes, validation: Validation, order: float, points: list[RippleEstimate]) -> None:
    """Amplitude above, phase below."""
    f = np.array([point.frequency for point in points])
    # About their middle, half the range in the logarithm.
    middle, half = np.log(f.min() * f.max()) / 2, max(np.log(1.44 * f.max() / f.min()), LEAST_DECADE) / 2
    grid = np.exp(np.linspace(middle - half, middle + half, 300))
    curve = modelled(validation, order, 2 * np.pi * grid / order)
    phase = np.rad2deg(np.unwrap(np.angle(curve)))
    above.plot(grid, np.abs(curve), color="#777777", linewidth=1.4, zorder=1)
    below.plot(grid, phase, color="#777777", linewidth=1.4, zorder=1)
    for point in points:
        colour, marker = sessions(validation)[point.session]
        how: dict[str, Any] = {
            "color": colour,
            "marker": marker,
            "markerfacecolor": face(colour, point.heldout),
            "markersize": 4.5,
        }
        above.errorbar(point.frequency, abs(point.value), yerr=point.noise, elinewidth=0.7, **how)
        if abs(point.value) > CLEAR * point.noise:
            model = complex(np.interp(point.frequency, grid, curve.real), np.interp(point.frequency, grid, curve.imag))
            off = np.angle(point.value / model) if model else np.angle(point.value)
            below.plot(point.frequency, np.interp(point.frequency, grid, phase) + np.rad2deg(off), **how)
    for axes in (above, below):
        axes.set_xscale("log")
        logarithmic(axes.xaxis)
        axes.set_xlim(grid[0], grid[-1])
    above.set_ylim(bottom=0)
    low, high = below.get_ylim()
    middle, half = (low + high) / 2, max(high - low, LEAST_PHASE) / 2
    below.set_ylim(middle - half, middle + half)
    style.label(above, "", f"amplitude [{unit(validation)}]")
    part = part_of(order, validation.table.recordings[0].gear_ratio)
    above.set_title(f"order {order:.6g}" + (f": {part}" if part else ""), loc="left", fontsize=9)
    style.label(below, "frequency [Hz]", "phase [degrees]")
