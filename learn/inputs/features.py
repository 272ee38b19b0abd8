"""Features of eqs. (7) to (9) and the three feature selections of Table III.

===========  ==========================================  =======================================
Selection    signals                                     efficiency
===========  ==========================================  =======================================
Selection 1  mean and variance of every gauge s0 to s4   relative efficiency, eq. (7)
Selection 2  Selection 1, and the DFT of every gauge     as Selection 1
Selection 3  DFT of the differences of opposite gauges,  fourth root of the change of the
             s1 - s3 and s2 - s4, eq. (8)                relative efficiency, eq. (9)
===========  ==========================================  =======================================

All signal features are relative to the healthy gear at the same operating point, eq. (7). ``conf/features`` has a file
for each selection; ``selection_all`` joins all features of Table III. With 6 orders the selections have 11, 41 and 13
features. Table VII compares the three.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.auxiliary_inputs import operating_point
from learn.inputs.inputs import Layout, LearningSet
from learn.inputs.references import healthy_reference
from swgsim.common.checks import require_integer, require_known, require_positive
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals
from swgsim.storage.orders import order_lines, whole_revolutions

SPECTRA = {"none": (), "gauges": SENSORS, "differences": ("ds13", "ds24"), "both": (*SENSORS, "ds13", "ds24")}
EFFICIENCIES = {"none": (), "eta_rel": ("eta_rel",), "eta2_rel": ("eta2_rel",), "both": ("eta_rel", "eta2_rel")}


@dataclass(frozen=True)
class Selection:
    """A feature selection like those of Table III.

    Attributes
    ----------
    name : str
        ``selection_1`` to ``selection_3`` for those of the paper.
    statistics : bool
        Mean and variance of every gauge signal.
    spectrum : {"none", "gauges", "differences", "both"}
        Signals with a DFT: none, the gauges, the differences of opposite gauges (eq. 8), or both.
    efficiency : {"none", "eta_rel", "eta2_rel", "both"}
        None, the relative efficiency (eq. 7), the fourth root of its change (eq. 9), or both.
    orders : int
        DFT components of each signal: orders 1 to `orders` of the wave generator's speed. The paper does not give
        this number.
    floor : float
        Smallest magnitude [mV/V] by which eq. (7) divides; its square for a variance. Symmetry makes some healthy
        values vanish, and eq. (7) would divide by rounding errors. The default of 1e-6 is far below measurable
        values: an amplifier noise of 5e-4 mV/V leaves 3e-5 in a window of 600 samples.
    operating_point : bool
        Whether speed, load and temperature are features too; the paper's selections have none of them.

    Raises
    ------
    ValueError
        If a value is not one of the choices or out of its limits.
    """

    name: str
    statistics: bool
    spectrum: str
    efficiency: str
    orders: int = 6
    floor: float = 1e-6
    operating_point: bool = False

    def __post_init__(self) -> None:
        require_known("spectrum", [self.spectrum], SPECTRA)
        require_known("efficiency", [self.efficiency], EFFICIENCIES)
        require_integer(self.name, "orders", self.orders, low=1, high=10_000)
        require_positive(self.name, floor=self.floor)  # else eq. 7 may divide by zero

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the features, in their order."""
        statistics = [f"{symbol}({s})" for symbol in ("m_rel", "var_rel") for s in SENSORS] if self.statistics else []
        spectrum = [f"DFT_rel({s})[{k}]" for s in SPECTRA[self.spectrum] for k in range(1, self.orders + 1)]
        auxiliary = ("speed", "load", "temperature") if self.operating_point else ()
        return (*statistics, *spectrum, *EFFICIENCIES[self.efficiency], *auxiliary)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Features of all samples, relative to the healthy reference of the same gear and operating point.

        Eq. (7) is evaluated as 1 + (m - m_healthy) / m_healthy for each feature. Only the divisor is bounded by the
        floor, so a healthy recording gives 1 even if the healthy value vanishes.

        Parameters
        ----------
        blocks : iterable of LabelledSignals
            Samples and references of a data set, in one or more blocks.

        Raises
        ------
        ValueError
            If a gear has no reference at an operating point, a reference efficiency is not above 0, or the window
            is shorter than a revolution.
        """
        parts = [(signal_quantities(block, self), block.table) for block in blocks]
        quantities = np.concatenate([part[0] for part in parts])
        facts = pd.concat([part[1] for part in parts], ignore_index=True)
        is_reference = facts["reference"].to_numpy()
        references, samples = facts[is_reference], facts[~is_reference].reset_index(drop=True)

        healthy = healthy_reference(quantities[is_reference], references, samples)
        divisor = np.copysign(np.maximum(np.abs(healthy), self.floors), healthy)
        relative = 1 + (quantities[~is_reference] - healthy) / divisor  # eq. 7

        measured = healthy_reference(references[["efficiency", "temperature_c"]].to_numpy(), references, samples)
        eta_healthy, temperature_healthy = measured[:, :1], measured[:, 1]
        if not (eta_healthy > 0).all():
            raise ValueError(f"healthy reference efficiency {eta_healthy.min():g} found, eq. 7 needs one above 0")
        eta_rel = samples[["efficiency"]].to_numpy() / eta_healthy
        efficiency = {"eta_rel": eta_rel, "eta2_rel": np.abs(1 - eta_rel) ** 0.25}  # eq. 9
        auxiliary = [efficiency[name] for name in EFFICIENCIES[self.efficiency]]
        if self.operating_point:
            auxiliary += [column[:, None] for column in operating_point(samples, temperature_healthy).values()]
        # Convolutional networks treat the features before the efficiency as a signal of one channel.
        layout = Layout(1, relative.shape[1], periodic=False)
        return LearningSet(np.concatenate([relative, *auxiliary], axis=1), samples, self.names, layout)

    @property
    def floors(self) -> Float[np.ndarray, " quantity"]:
        """Floor of each signal feature [mV/V; its square for variances]."""
        statistics = np.repeat([self.floor, self.floor**2], len(SENSORS)) if self.statistics else np.empty(0)
        return np.append(statistics, np.full(len(SPECTRA[self.spectrum]) * self.orders, self.floor))


def signal_quantities(recordings: LabelledSignals, selection: Selection) -> Float[np.ndarray, "sample quantity"]:
    """Means [mV/V], variances [its square] and DFT magnitudes [mV/V] of a selection, before eq. (7).

    They are taken over the largest whole number of revolutions at the desired speed.
    """
    result = np.empty((len(recordings), len(selection.floors)))
    speeds = recordings.table["n_in_rpm"].to_numpy()
    for speed in np.unique(speeds):
        rows = speeds == speed
        length = whole_revolutions(float(speed), recordings.rate, recordings.signals.shape[-1])
        s = recordings.signals[rows, :, :length].astype(np.float64)
        quantities = [s.mean(axis=-1), s.var(axis=-1)] if selection.statistics else []
        if selection.spectrum != "none":
            differences = s[:, 1:3] - s[:, 3:5]  # eq. 8: s1 - s3, s2 - s4
            channels = {"gauges": s, "differences": differences, "both": np.concatenate([s, differences], axis=1)}
            lines = order_lines(channels[selection.spectrum], float(speed), recordings.rate, selection.orders)
            quantities.append(np.abs(lines[:, :, 1:]).reshape(len(s), -1))
        result[rows] = np.concatenate([np.empty((len(s), 0)), *quantities], axis=1)
    return result
