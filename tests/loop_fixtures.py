"""Recordings by formula and fitted models with fabricated Gaussian numbers, for tests of the loop without the chain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from chain_fixtures import GEAR

from swgsim.effects import Effect
from swgsim.effects.quantity import phase, size
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import Layout
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.fitted import Allowed, Fitted
from swgsim.identification.fit.map_fit import Calibrated
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search.hypotheses import Hypothesis
from swgsim.recordings.recording import Recording

POINTS = tuple(OperatingPoint(n, T) for n in (2000.0, 4000.0) for T in (7.0, 39.0, 70.0))


@dataclass(frozen=True)
class Bump(Effect):
    """An effect with a size and nothing else."""

    height: float = size(unit="-", low=-100, high=100, typical=2)


@dataclass(frozen=True)
class Wave(Effect):
    """An effect with a size and a phase."""

    height: float = size(unit="-", low=0, high=100, typical=2)
    theta: float = phase()


BUMP, WAVE = Hypothesis(Bump, (), 1), Hypothesis(Wave, (), 1)


def recorded(
    channels: Mapping[str, np.ndarray],
    point: OperatingPoint = POINTS[0],
    rate: float = 10_000.0,
    conditions: Conditions | None = None,
) -> Recording:
    """A recording of given channels."""
    samples = len(next(iter(channels.values())))
    return Recording("a", "1", "1", point, 1, np.arange(samples) / rate, channels, conditions or Conditions())


def turning(point: OperatingPoint, revolutions: float, rate: float) -> np.ndarray:
    """Angle of a wave generator whose speed ripples by 2 % [rad]."""
    time = np.arange(int(revolutions * 60 / point.n_in_rpm * rate)) / rate
    speed = 2 * np.pi * point.n_in_rpm / 60
    return 0.3 + speed * time + 0.02 * np.sin(speed * time)


def silent(points: Sequence[OperatingPoint], repeats: int) -> tuple[Recording, ...]:
    """Recordings of which only the operating point and the number matter."""
    empty = np.zeros(2)
    return tuple(
        replace(recorded({"phi_in": empty}, point), repeat=repeat)
        for point, repeat in product(points, range(1, repeats + 1))
    )


def fitted_to(
    layout: Layout,
    rng: np.random.Generator,
    *,
    points: Sequence[OperatingPoint] = POINTS,
    repeats: int = 1,
    open_: int = 4,
    reach: float = 3.0,
) -> Fitted:
    """A fitted model of silent recordings with random errors of single recordings and random open directions.

    ``reach`` is the size of an open direction in units of the noise, row by row.
    """
    recordings = silent(points, repeats)
    rows = len(recordings) * len(layout)
    variance = rng.uniform(0.5, 2.0, (len(recordings), len(layout)))
    measured = Measured(recordings, layout, np.zeros(variance.shape), variance)
    errors = Covariance(RecordingCovariance.white(variance), rng.normal(0, 0.5, (rows, 3)))
    situations = len(measured.situations)
    calibrated = Calibrated(
        Model(GEAR), {}, np.zeros((situations, len(layout))), np.zeros((situations, len(layout), 0)), True
    )
    directions = reach * rng.standard_normal((rows, open_))
    return Fitted(
        measured,
        Unit(Model(GEAR)),
        {},
        calibrated,
        Scatter({}, 0, np.zeros((0, 0))),
        errors,
        directions,
        np.zeros(rows),
        Allowed.nothing(rows),
    )


def holding(fitted: Fitted, residual: np.ndarray) -> Fitted:
    """The same with another residual."""
    values = residual.reshape(fitted.measured.values.shape)
    return replace(fitted, measured=replace(fitted.measured, values=values))


def drawn(covariance: Covariance, rng: np.random.Generator) -> np.ndarray:
    """A residual with this covariance."""
    return covariance.drawn(rng, 1)[:, 0]
