"""Features of eqs. 7 to 9 and the feature selections of Table III."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.auxiliary_inputs import operating_point
from learn.inputs.inputs import Layout, LearningSet
from learn.inputs.references import healthy_reference
from swgsim.storage.labelled_signals import SENSORS, LabelledSignals
from swgsim.storage.orders import order_lines, whole_revolutions

SPECTRA = {"none": (), "gauges": SENSORS, "differences": ("ds13", "ds24"), "both": (*SENSORS, "ds13", "ds24")}
EFFICIENCIES = {"none": (), "eta_rel": ("eta_rel",), "eta2_rel": ("eta2_rel",), "both": ("eta_rel", "eta2_rel")}


@dataclass(frozen=True)
class Selection:
    """A feature selection of Table III.

    Attributes
    ----------
    name : str
        Its name, ``selection_1`` to ``selection_3`` for the paper's.
    statistics : bool
        Mean and variance of every gauge signal.
    spectrum : {"none", "gauges", "differences", "both"}
        DFT of nothing, of every gauge signal, of the differences of opposite gauges (eq. 8), or of both.
    efficiency : {"none", "eta_rel", "eta2_rel", "both"}
        Nothing, the relative efficiency, the fourth root of its change (eq. 9), or both.
    orders : int
        DFT components per signal: the multiples 1 to `orders` of the wave generator's speed n_in. The paper does not
        say how many it takes.
    floor : float
        Smallest magnitude of a healthy mean or DFT component [mV/V] that eq. 7 divides by; its square for a variance.
        Where symmetry makes the healthy value vanish, eq. 7 would divide by rounding errors instead. The default,
        1e-6, bounds the quotient and touches nothing that could be measured: of an amplifier's noise of 5e-4 mV/V a
        window of 600 samples leaves 3e-5.
    operating_point : bool
        Speed, load and temperature as well, which the paper's selections do not have.

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
        if self.spectrum not in SPECTRA:
            raise ValueError(f"unknown spectrum {self.spectrum!r}; choose from {', '.join(SPECTRA)}")
        if self.efficiency not in EFFICIENCIES:
            raise ValueError(f"unknown efficiency {self.efficiency!r}; choose from {', '.join(EFFICIENCIES)}")
        if self.orders < 1:
            raise ValueError(f"{self.orders} DFT orders, at least 1 is needed; take spectrum=none to do without")
        if not self.floor > 0:
            raise ValueError(f"floor {self.floor} mV/V must be above 0, else eq. 7 may divide by zero; 1e-6 is usual")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the features, in their order."""
        statistics = [f"{symbol}({s})" for symbol in ("m_rel", "var_rel") for s in SENSORS] if self.statistics else []
        spectrum = [f"DFT_rel({s})[{k}]" for s in SPECTRA[self.spectrum] for k in range(1, self.orders + 1)]
        side = ("speed", "load", "temperature") if self.operating_point else ()
        return (*statistics, *spectrum, *EFFICIENCIES[self.efficiency], *side)

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Features of all samples relative to the healthy reference of their own gear and operating point.

        Eq. 7, component by component, as 1 + (m - m_healthy) / m_healthy: the divisor alone is kept from falling
        below the floor, so a healthy recording gives 1 also where the healthy value vanishes.

        Parameters
        ----------
        blocks : iterable of LabelledSignals
            The recordings of a data set, samples and references, in one block or in many that are dropped one by one.

        Raises
        ------
        ValueError
            If a gear has no reference at an operating point, if its reference efficiency is not above 0, or if the
            window holds no whole revolution.
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
        last = [efficiency[name] for name in EFFICIENCIES[self.efficiency]]
        if self.operating_point:
            last += [column[:, None] for column in operating_point(samples, temperature_healthy).values()]
        # Networks on signals may take the features before the efficiency for one: a row of numbers.
        layout = Layout(1, relative.shape[1], periodic=False)
        return LearningSet(np.concatenate([relative, *last], axis=1), samples, self.names, layout)

    @property
    def floors(self) -> Float[np.ndarray, " quantity"]:
        """Floor of each signal feature: mV/V, or its square for the variances."""
        statistics = np.repeat([self.floor, self.floor**2], len(SENSORS)) if self.statistics else np.empty(0)
        return np.append(statistics, np.full(len(SPECTRA[self.spectrum]) * self.orders, self.floor))


def signal_quantities(recordings: LabelledSignals, selection: Selection) -> Float[np.ndarray, "sample quantity"]:
    """The selection's means and variances [mV/V, squared], and DFT magnitudes [mV/V] before they are set in relation.

    All are taken over the largest whole number of revolutions at the recording's desired speed.
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
