"""Simulation-based calibration of a diagnosis: faults drawn from the prior must lie where their posterior says.

Reference: S. Talts and others, Validating Bayesian Inference Algorithms with Simulation-Based Calibration (2018).
"""

import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Bool
from matplotlib.figure import Figure
from scipy.stats import binom

from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Sessions, record_sessions
from swgsim.chain.chain import SECTORS
from swgsim.common import style
from swgsim.common.seeds import generator
from swgsim.dataset.faults import FAULTS
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.identification.calls import commission
from swgsim.identification.data.angle_zero import from_zero
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitting import fit
from swgsim.oracle.diagnosis import ENDS
from swgsim.oracle.severity import Severities
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin.fault_posterior import Suspected
from swgsim.twin.unit_diagnosis import partitions

BINS, BAND = 10, "#dddddd"


def calibration(
    suspected: Suspected, chosen: Bool[np.ndarray, " recording"], draws: int, rng: np.random.Generator
) -> pd.DataFrame:
    """Diagnoses of simulated recordings, whose class, size and position are drawn from the prior.

    Returns
    -------
    DataFrame
        One column per class with its probability; ``label``, the true class; ``below``, the posterior probability of
        a size below the true one, given the true class (NaN for healthy ones).
    """
    fitted, measured, of = suspected.fitted, suspected.fitted.measured, suspected.partitions
    labels = rng.choice(CLASSES, draws, p=[suspected.prior[label] for label in CLASSES])
    sizes = np.array([rng.uniform(of[each].low, of[each].high) if each in of else np.nan for each in labels])
    drawn = zip(labels, sizes.tolist(), rng.uniform(0, 2 * np.pi, draws).tolist(), strict=True)
    models = [fitted.model.plus(*([FAULTS[label](*where)] if label in of else [])) for label, *where in drawn]
    predicted = predict([fitted.model, *models], measured.situations, measured.layout)
    changes = measured.rows(np.moveaxis(predicted[1:] - predicted[0], 0, -1))[np.repeat(chosen, len(measured.layout))]
    errors = fitted.whole.recordings(chosen).drawn(rng, draws)
    found = suspected.posterior_of(chosen, errors + changes * (1 + fitted.unit.structure * rng.standard_normal(draws)))
    table = pd.DataFrame(found.posterior, columns=list(CLASSES)).assign(label=labels, below=np.nan)
    for label, partition in of.items():
        rows = np.flatnonzero(labels == label)
        severities = Severities.of(partition, found.model.places(found.x[rows], label))
        table.loc[rows, "below"] = severities.below(sizes[rows])
    return table


def figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Ranks of true sizes, and shares of right classes over their probability, each with what chance allows (95 %)."""
    picture = style.figure(9.5, 3.1 * len(tables))
    for (name, table), (ranks, classes) in zip(tables.items(), picture.subplots(len(tables), 2), strict=True):
        below = table["below"].dropna()
        ranks.hist(below, np.linspace(0, 1, BINS + 1), color=style.CLASS_COLOURS["reduced_stiffness"])
        ranks.axhspan(*binom.ppf(ENDS, len(below), 1 / BINS), color=BAND, zorder=0)
        style.label(ranks, "posterior probability of a size below the true one", "draws", name)
        p = table[list(CLASSES)].to_numpy().ravel()
        true = (table["label"].to_numpy()[:, None] == np.array(CLASSES)).ravel()
        bins = np.minimum((BINS * p).astype(int), BINS - 1)
        count = np.bincount(bins, minlength=BINS)
        mean = np.bincount(bins, p, BINS) / count
        classes.fill_between(mean, *(binom.ppf(end, count, mean) / count for end in ENDS), color=BAND)
        classes.plot(mean, np.bincount(bins, true, BINS) / count, "o", color=style.CLASS_COLOURS["root_tooth_crack"])
        style.label(classes, "probability of a class", "share of cases in which it is true", name)
    return picture


if __name__ == "__main__":
    POINTS = tuple(OperatingPoint(n, T) for n in (2000.0, 4000.0) for T in (7.0, 39.0, 70.0))
    healthy = record_sessions(Gear(), (), Sessions(POINTS), Bench(), seed=1, window=Window(), sectors=SECTORS)
    unit = commission(healthy, Gear())
    new = record_sessions(Gear(), (), Sessions(POINTS), Bench(), seed=2, window=Window(), sectors=SECTORS)
    found = Suspected.of(fit(Measured.of(from_zero(new, unit.zero)), unit), partitions(), dict.fromkeys(CLASSES, 1 / 6))
    every, one = np.ones(len(new), bool), np.arange(len(new)) == 1
    rng = generator("calibration")
    tables = {"all recordings": calibration(found, every, 1000, rng), "one of them": calibration(found, one, 1000, rng)}
    Path(sys.argv[1]).write_bytes(style.png(figure(tables)))
