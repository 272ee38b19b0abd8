"""Is one filter behind all ripples of a torque sensor? Filters that all orders share, judged on sessions kept out.

``python tests/joint/sensor_filter.py measured/kinova_gen3_joint7`` prints the figures of docs/joints.md. Each order of
the motor has a constant part and one that grows with speed; both pass the filter.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.signal import periodogram

from swgsim.joint.effects.ripple import STATED, Ripple
from swgsim.joint.identify import recordings_of
from swgsim.joint.recording import JointRecording
from swgsim.joint.regression import Fit, Table, fit, rms
from swgsim.joint.term import Term
from swgsim.joint.textbook import RigidBody

OUTPUT, MOTOR = (2.0, 3.0, 4.0, 8.0), (200.0, 400.0, 700.0, 800.0, 2100.0)
STRONGEST = 700.0
# Alias of the strongest order, as the search finds it: its frequency at rest, and half the width of its line [Hz].
ALIAS, BAND = 249.0, 20.0
# Slower runs have their alias near the noise [rad/s].
SLOWEST = 0.5
Parameters = tuple[float, ...]


class Filter(NamedTuple):
    """Names of parameters, where their search begins, their bounds, and the response at frequencies [Hz]."""

    names: tuple[str, ...]
    start: Parameters
    bounds: tuple[tuple[float, float], ...]
    response: Callable[[Parameters, np.ndarray], np.ndarray]


def lag(f: np.ndarray, milliseconds: float) -> np.ndarray:
    """Response of a lag."""
    return np.exp(-2e-3j * np.pi * f * milliseconds)


def second_order(p: Parameters, f: np.ndarray) -> np.ndarray:
    """Response of a resonance with corner [Hz] and damping."""
    return 1 / (1 - (f / p[0]) ** 2 + 2j * p[1] * f / p[0])


CORNER, LAG = (20.0, 2000.0), (-5.0, 5.0)
SECOND_ORDER = Filter(("corner [Hz]", "damping"), (150.0, 0.8), (CORNER, (0.1, 1.5)), second_order)
FILTERS = {
    "no filter": Filter((), (), (), lambda _, f: np.ones(f.shape)),
    "lag": Filter(("lag [ms]",), (1.0,), (LAG,), lambda p, f: lag(f, *p)),
    "first order and lag": Filter(
        ("corner [Hz]", "lag [ms]"), (150.0, 1.0), (CORNER, LAG), lambda p, f: lag(f, p[1]) / (1 + 1j * f / p[0])
    ),
    "second order": SECOND_ORDER,
    "second order of its own for each": SECOND_ORDER,
    "sample and hold, and lag": Filter(
        ("rate [Hz]", "lag [ms]"), (200.0, 1.0), (CORNER, LAG), lambda p, f: np.sinc(f / p[0]) * lag(f, p[1])
    ),
}


@dataclass(frozen=True)
class FilteredWave(Term):
    """A wave with a constant part and one that grows with speed, through a filter."""

    order: float = 1.0
    response: Callable[[np.ndarray], np.ndarray] = np.ones_like

    def columns(self, recording: JointRecording) -> np.ndarray:
        """Cosine and sine of both parts."""
        f = self.order * recording.speed / (2 * np.pi)
        wave = np.exp(1j * self.order * recording.signals["q"]) * self.response(f)
        return np.stack([part for each in (wave, wave * 1j * f / STATED) for part in (each.real, each.imag)], axis=1)


def through(table: Table, kind: Filter, of_orders: Sequence[Parameters]) -> Fit:
    """Textbook, orders of the output, and orders of the motor through filters."""
    motor = (
        FilteredWave(order=order, response=partial(kind.response, p)) for order, p in zip(MOTOR, of_orders, strict=True)
    )
    return fit(table, (RigidBody(modelled=False), *map(Ripple, OUTPUT), *motor))


def best(table: Table, kind: Filter, shared: bool) -> tuple[list[Parameters], Fit]:
    """The parameters with the least error, of all orders or of one order after another, twice."""
    found = [kind.start] * len(MOTOR)

    def moved(p: Parameters, orders: Sequence[int]) -> list[Parameters]:
        return [tuple(p) if number in orders else own for number, own in enumerate(found)]

    groups = [list(range(len(MOTOR)))] if shared else [[number] for number in range(len(MOTOR))] * 2
    options = {"maxfev": 40 * len(kind.start), "xatol": 1e-2, "fatol": 1e-7}
    for orders in groups if kind.start else []:
        lowest = minimize(
            lambda p, orders=orders: through(table, kind, moved(p, orders)).error,
            found[orders[0]], method="Nelder-Mead", bounds=kind.bounds, options=options,
        )  # fmt: skip
        found = moved(lowest.x, orders)
    return found, through(table, kind, found)


def images(found: Fit, table: Table) -> Iterator[tuple[str, float, float, float]]:
    """Amplitude of the alias in the residual of each fast run, that of the image, and that of the whole residual.

    A sampled and held wave of frequency f has an image at ALIAS - f, f / (ALIAS - f) times as large.
    """
    missed = found.missed(table)
    (wave,) = (term for term in found.terms if isinstance(term, FilteredWave) and term.order == STRONGEST)
    for number, each in enumerate(table.recordings):
        speed, own = float(each.speed.mean()), missed[table.run == number]
        if speed > SLOWEST:
            f = STRONGEST * speed / (2 * np.pi)
            at, power = periodogram(own, each.rate, scaling="spectrum")
            seen = float(np.sqrt(2 * power[np.abs(at - (ALIAS - f)) < BAND].sum()))
            amplitude, rest = (float(np.sqrt(2) * rms(values)) for values in (wave.signal(each), own))
            yield each.name, seen, amplitude * f / (ALIAS - f), rest


def main(folder: Path, sessions: Sequence[str]) -> None:
    """Print filters and images, for each session kept out."""
    every = recordings_of("kinova_gen3", folder).recordings
    for session in sessions or ("S3", "S2", "S1"):
        kept = Table(tuple(each for each in every if each.session != session), "T_sensor")
        judging = Table(tuple(each for each in every if each.session == session), "T_sensor")
        fast = np.concatenate([np.full(len(each), each.speed.mean() > 1) for each in judging.recordings])
        for name, kind in FILTERS.items():
            parameters, found = best(kept, kind, shared="own" not in name)
            missed = found.missed(judging)
            above = f", above 1 rad/s {rms(missed[fast]):.4f}, below {rms(missed[~fast]):.4f}" if fast.any() else ""
            values = "; ".join(" ".join(f"{value:.4g}" for value in p) for p in dict.fromkeys(parameters))
            print(f"{session} kept out: error {rms(missed):.4f}{above} N m: {name}, {', '.join(kind.names)} {values}")
        for run, seen, image, rest in images(found, judging):
            print(f"  {run}: amplitude near the alias {seen:.4f}, of the image {image:.4f}, of all {rest:.4f} N m")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
