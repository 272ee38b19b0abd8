"""Order lines relative to the healthy gear: what a fault changes, without what load and trigger have changed.

A recording never meets its reference's operating point exactly. A load that is off by dT adds dT times the slope of the
lines over the load, and a trigger that is off by an angle d turns the line of order k by k d. Both directions follow
from the gear's own healthy acquisitions, so both are fitted to the difference and taken out of it. What remains of a
healthy recording is the noise.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float

from learn.references import OPERATING_POINT, healthy_reference
from swgsim.orders import lines_of
from swgsim.recordings import Recordings


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
    eta_healthy, temperature_healthy : array (sample,)
        Means of the reference acquisitions [-, degC].
    """

    table: pd.DataFrame
    lines: Complex[np.ndarray, "sample sensor order"]
    reference: Complex[np.ndarray, "sample sensor order"]
    slope: Complex[np.ndarray, "sample sensor order"]
    eta_healthy: Float[np.ndarray, " sample"]
    temperature_healthy: Float[np.ndarray, " sample"]


def healthy_lines(blocks: Iterable[Recordings], orders: int, acquisitions: int | None = None) -> HealthyLines:
    """Order lines of all samples beside those of their healthy reference.

    Parameters
    ----------
    blocks : iterable of Recordings
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
    parts = [(lines_of(block, orders), block.table) for block in blocks]
    lines = np.concatenate([part[0] for part in parts])
    facts = pd.concat([part[1] for part in parts], ignore_index=True)
    is_reference = facts["reference"].to_numpy()
    samples = facts[~is_reference].reset_index(drop=True)
    chosen = np.flatnonzero(is_reference)
    if acquisitions is not None:
        chosen = chosen[facts.iloc[chosen].groupby(OPERATING_POINT).cumcount().to_numpy() < acquisitions]
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
        samples, lines[~is_reference], healthy(lines[chosen], samples), healthy(slope, samples), *measured.T
    )


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


def residual(healthy: HealthyLines) -> tuple[Complex[np.ndarray, "sample sensor order"], Float[np.ndarray, "sample 2"]]:
    """What remains of each recording beside its reference when errors of load and trigger angle are taken out.

    The two errors are fitted to the orders from 1 on, where the noise is the same on every line; order 0, which carries
    the drift of the zeros, has no say.

    Returns
    -------
    array (sample, sensor, order)
        [mV/V].
    array (sample, 2)
        Fitted errors of the load [N m] and of the trigger angle [rad].
    """
    difference = healthy.lines - healthy.reference
    turned = 1j * np.arange(difference.shape[-1]) * healthy.reference
    directions = np.stack([healthy.slope, turned], axis=1)  # (sample, error, sensor, order)
    fitted = _real(directions[..., 1:])  # (sample, error, value)
    gram = fitted @ fitted.transpose(0, 2, 1)
    projected = np.einsum("nev,nv->ne", fitted, _real(difference[..., 1:]))
    errors = np.einsum("nef,nf->ne", np.linalg.pinv(gram, hermitian=True), projected)
    return difference - np.einsum("ne,neso->nso", errors, directions), errors


def _real(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts of the last two axes, as one axis."""
    flat = values.reshape(*values.shape[:-2], -1)
    return np.concatenate([flat.real, flat.imag], axis=-1)
