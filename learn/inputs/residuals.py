"""Order lines relative to the healthy gear: what a fault changes, without what load, speed and trigger have changed.

A recording never meets its reference's operating point exactly. A load that is off by dT adds dT times the slope of the
lines over the load; a trigger that is off by an angle d turns the line of order k by k d; and a speed that is off lets
the lines leak into each other, as the window then holds no whole revolutions. All three directions follow from the
gear's own healthy acquisitions, so they are fitted to the difference and taken out of it.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float, Int

from learn.inputs.references import HEALTHY, healthy_reference
from swgsim.common.checks import require_integer
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.storage.orders import lines_of, whole_revolutions


@dataclass(frozen=True)
class HealthyLines:
    """Recordings as order lines, with those of their healthy reference.

    Attributes
    ----------
    table : DataFrame
        Facts of the samples.
    lines, reference, slope : array (sample, sensor, order)
        Lines of the recording [mV/V], healthy lines of its gear and operating point [mV/V], and their slope over the
        load [mV/V per N m]; a gear with references at a single load has no slope and gets zeros.
    revolutions : array (sample,)
        Of the wave generator, over which the lines are taken.
    eta_healthy, temperature_healthy : array (sample,)
        Means of the reference acquisitions [-, degC].
    """

    table: pd.DataFrame
    lines: Complex[np.ndarray, "sample sensor order"]
    reference: Complex[np.ndarray, "sample sensor order"]
    slope: Complex[np.ndarray, "sample sensor order"]
    revolutions: Int[np.ndarray, " sample"]
    eta_healthy: Float[np.ndarray, " sample"]
    temperature_healthy: Float[np.ndarray, " sample"]


def require_acquisitions(owner: str, acquisitions: int | None) -> None:
    """Raise a ValueError unless :func:`healthy_lines` can use so many reference acquisitions."""
    if acquisitions is not None:
        require_integer(owner, "acquisitions", acquisitions, low=1, high=10_000)


def healthy_lines(blocks: Iterable[LabelledSignals], orders: int, acquisitions: int | None = None) -> HealthyLines:
    """Order lines of all samples beside those of their healthy reference.

    Parameters
    ----------
    blocks : iterable of LabelledSignals
        Samples and references of a data set.
    orders : int
        Highest order.
    acquisitions : int or None
        Reference acquisitions to use of each gear and operating point, the first ones; None for all.

    Raises
    ------
    ValueError
        If a gear has no reference at an operating point, or a reference efficiency is not above 0.
    """
    parts = [(lines_of(block, orders), _revolutions(block), block.table) for block in blocks]
    lines, revolutions = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    facts = pd.concat([part[2] for part in parts], ignore_index=True)
    is_reference = facts["reference"].to_numpy()
    samples = facts[~is_reference].reset_index(drop=True)
    chosen = np.flatnonzero(is_reference)
    if acquisitions is not None:
        chosen = chosen[facts.iloc[chosen].groupby(HEALTHY).cumcount().to_numpy() < acquisitions]
    references = facts.iloc[chosen]

    def healthy(values: Complex[np.ndarray, "reference sensor order"], of: pd.DataFrame) -> np.ndarray:
        flat = values.reshape(len(values), -1)
        mean = healthy_reference(flat.real, references, of) + 1j * healthy_reference(flat.imag, references, of)
        return mean.reshape(len(of), *values.shape[1:])

    # Slopes come from all loads of the references: which samples are there beside a sample does not change it.
    slope = _slope(healthy(lines[chosen], references), references)
    measured = healthy_reference(references[["efficiency", "temperature_c"]].to_numpy(), references, samples)
    if not (measured[:, 0] > 0).all():
        raise ValueError(f"healthy reference efficiency {measured[:, 0].min():g} found, it must be above 0")
    return HealthyLines(
        samples, lines[~is_reference], healthy(lines[chosen], samples), healthy(slope, samples),
        revolutions[~is_reference], *measured.T,
    )  # fmt: skip


def _revolutions(recordings: LabelledSignals) -> Int[np.ndarray, " sample"]:
    length, rate = recordings.signals.shape[-1], recordings.rate
    return np.array([
        round(whole_revolutions(speed, rate, length) * speed / 60 / rate) for speed in recordings.table["n_in_rpm"]
    ], dtype=int)  # fmt: skip


def _slope(
    mean: Complex[np.ndarray, "reference sensor order"], references: pd.DataFrame
) -> Complex[np.ndarray, "reference sensor order"]:
    """Slope of the mean at each reference's operating point over the load, from all loads of its gear and speed."""
    slope = np.zeros_like(mean)
    load = references["T_out_nm"].to_numpy()
    for rows in references.groupby(["gear", "n_in_rpm"]).indices.values():
        loads, first, which = np.unique(load[rows], return_index=True, return_inverse=True)
        if len(loads) > 1:
            slope[rows] = np.gradient(mean[rows[first]], loads, axis=0)[which]
    return slope


@dataclass(frozen=True)
class Accuracy:
    """How far off a test bench is, as its user would declare it: standard deviations, estimates.

    Without it the fit would be ill-conditioned, as errors of load and trigger both show mainly at order 2: it would
    take what else varies from one healthy recording to the next for errors of load ten times those that are possible.

    Attributes
    ----------
    load, speed : float
        Relative to their set points.
    angle : float
        Of the trigger [rad].
    line : float
        Scatter of a line's real or imaginary part that is none of these [mV/V].
    """

    load: float = 0.01
    angle: float = 0.005
    speed: float = 0.002
    line: float = 1e-4


BENCH = Accuracy()
ERRORS = ("load error", "angle error", "speed error")


def residual(
    healthy: HealthyLines, accuracy: Accuracy = BENCH
) -> tuple[Complex[np.ndarray, "sample sensor order"], Float[np.ndarray, "sample error"]]:
    """What remains of each recording beside its reference when errors of load, trigger and speed are taken out.

    They are the most probable ones given the orders from 1 on, where the noise is the same on every line; order 0,
    which carries the drift of the zeros, has no say.

    Returns
    -------
    array (sample, sensor, order)
        [mV/V].
    array (sample, error)
        The errors that :data:`ERRORS` names: of the load [N m], of the trigger's angle [rad], of the speed [-].
    """
    difference = healthy.lines - healthy.reference
    turned = 1j * np.arange(difference.shape[-1]) * healthy.reference
    directions = np.stack([healthy.slope, turned, leakage(healthy.reference, healthy.revolutions)], axis=1)
    load = np.abs(healthy.table["T_out_nm"].to_numpy())
    likely = np.stack(np.broadcast_arrays(accuracy.load * load, accuracy.angle, accuracy.speed), axis=1)
    # In units of what is likely, so that an error that cannot be, as of a load of zero, is no special case.
    scaled = _real(directions[..., 1:]) * likely[:, :, None] / accuracy.line  # (sample, error, value)
    projected = np.einsum("nev,nv->ne", scaled, _real(difference[..., 1:]) / accuracy.line)
    information = scaled @ scaled.transpose(0, 2, 1) + np.eye(len(ERRORS))
    errors = likely * np.linalg.solve(information, projected[:, :, None])[:, :, 0]
    return difference - np.einsum("ne,neso->nso", errors, directions), errors


def leakage(
    lines: Complex[np.ndarray, "sample sensor order"], revolutions: Int[np.ndarray, " sample"]
) -> Complex[np.ndarray, "sample sensor order"]:
    """Change of the lines per relative error of the speed [mV/V].

    A window that is made for the set speed holds the signal at ``(1 + e) theta``: to first order it gains
    ``e theta s'(theta)``, whose lines over n revolutions are integrals of ``theta exp(i m theta)``.
    """
    k = np.arange(lines.shape[-1])
    j = k[:, None]  # the order that is leaked into
    with np.errstate(divide="ignore", invalid="ignore"):
        direct, mirrored = np.where(j == k, 0, k / (k - j)), np.where(j + k == 0, 0, k / (k + j))
    leaked = lines @ direct.T + lines.conj() @ mirrored.T
    leaked[..., 0] /= 2  # the mean is counted once
    return leaked + 1j * np.pi * revolutions[:, None, None] * k * lines


def _real(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts of the last two axes, as one axis."""
    flat = values.reshape(*values.shape[:-2], -1)
    return np.concatenate([flat.real, flat.imag], axis=-1)
