"""Residual order lines: the difference to the healthy gear, without errors of load, trigger and speed.

A recording never has exactly the operating point of its reference. Three errors of the bench change its lines. A load
error dT adds dT times the slope of the lines over the load. A trigger error, an angle d, turns the line of order k by
k d. With a speed error the window is no whole number of revolutions, and lines leak into each other. All three
directions follow from the healthy acquisitions of the gear. They are fitted to the difference and subtracted.
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
    """Order lines of recordings and of their healthy references.

    Attributes
    ----------
    table : DataFrame
        Facts of the samples.
    lines, reference, slope : array (sample, sensor, order)
        Lines of the recording [mV/V], healthy lines of the same gear and operating point [mV/V], and their slope over
        the load [mV/V per N m]. The slope is zero if the gear has references at one load only.
    revolutions : array (sample,)
        Number of revolutions of the wave generator over which the lines are taken.
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
    """Raise a ValueError unless this is a possible number of reference acquisitions."""
    if acquisitions is not None:
        require_integer(owner, "acquisitions", acquisitions, low=1, high=10_000)


def healthy_lines(blocks: Iterable[LabelledSignals], orders: int, acquisitions: int | None = None) -> HealthyLines:
    """Order lines of all samples and of their healthy references.

    Parameters
    ----------
    blocks : iterable of LabelledSignals
        Samples and references of a data set.
    orders : int
        Highest order.
    acquisitions : int or None
        Number of reference acquisitions to use of each gear and operating point, the first ones; None for all.

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

    # Slopes come from all loads of the references, so they do not depend on the other samples.
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
    """Slope of the mean over the load at each reference, from all loads of the same gear and speed."""
    slope = np.zeros_like(mean)
    load = references["T_out_nm"].to_numpy()
    for rows in references.groupby(["gear", "n_in_rpm"]).indices.values():
        loads, first, which = np.unique(load[rows], return_index=True, return_inverse=True)
        if len(loads) > 1:
            slope[rows] = np.gradient(mean[rows[first]], loads, axis=0)[which]
    return slope


@dataclass(frozen=True)
class Accuracy:
    """Prior standard deviations of the errors of a test bench, estimates.

    Without a prior the fit is ill-conditioned, as errors of load and trigger both act mainly on order 2. Other healthy
    variability would then be fitted by load errors ten times the possible ones.

    Attributes
    ----------
    load, speed : float
        Errors relative to the set points [-].
    angle : float
        Error of the trigger [rad].
    line : float
        Scatter of the real or imaginary part of a line from all other causes [mV/V].
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
    """Difference of each recording to its reference after subtraction of errors of load, trigger and speed.

    The errors are the maximum of the posterior given the orders from 1 on, with equal noise on all lines. Order 0 is
    not used, because zeros drift.

    Returns
    -------
    array (sample, sensor, order)
        [mV/V].
    array (sample, error)
        Errors in the order of :data:`ERRORS`: load [N m], trigger angle [rad], speed [-].
    """
    difference = healthy.lines - healthy.reference
    rotation = 1j * np.arange(difference.shape[-1]) * healthy.reference
    directions = np.stack([healthy.slope, rotation, leakage(healthy.reference, healthy.revolutions)], axis=1)
    load = np.abs(healthy.table["T_out_nm"].to_numpy())
    prior = np.stack(np.broadcast_arrays(accuracy.load * load, accuracy.angle, accuracy.speed), axis=1)
    # In units of the prior, so that an error with a prior of zero (at zero load) is no special case.
    scaled = _real(directions[..., 1:]) * prior[:, :, None] / accuracy.line  # (sample, error, value)
    projected = np.einsum("nev,nv->ne", scaled, _real(difference[..., 1:]) / accuracy.line)
    information = scaled @ scaled.transpose(0, 2, 1) + np.eye(len(ERRORS))
    errors = prior * np.linalg.solve(information, projected[:, :, None])[:, :, 0]
    return difference - np.einsum("ne,neso->nso", errors, directions), errors


def leakage(
    lines: Complex[np.ndarray, "sample sensor order"], revolutions: Int[np.ndarray, " sample"]
) -> Complex[np.ndarray, "sample sensor order"]:
    """Change of the lines per relative error of the speed [mV/V].

    A window for the set speed then contains the signal at ``(1 + e) theta``. To first order this adds
    ``e theta s'(theta)``, whose lines over n revolutions are integrals of ``theta exp(i m theta)``.
    """
    k = np.arange(lines.shape[-1])
    j = k[:, None]  # order that receives the leakage
    with np.errstate(divide="ignore", invalid="ignore"):
        direct, mirrored = np.where(j == k, 0, k / (k - j)), np.where(j + k == 0, 0, k / (k + j))
    leaked = lines @ direct.T + lines.conj() @ mirrored.T
    leaked[..., 0] /= 2  # the mean is counted once
    return leaked + 1j * np.pi * revolutions[:, None, None] * k * lines


def _real(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts of the last two axes, as one axis."""
    flat = values.reshape(*values.shape[:-2], -1)
    return np.concatenate([flat.real, flat.imag], axis=-1)
