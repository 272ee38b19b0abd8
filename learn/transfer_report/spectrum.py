"""Where the disturbance of eq. 10 lies beside the faults, order by order, from the clean and the disturbed data set."""

from pathlib import Path

import numpy as np
import pandas as pd

from learn.inputs.residuals import healthy_lines
from learn.paper.paper_page import require_same_code
from swgsim.common.style import words
from swgsim.storage import storage

BLOCK = 1024  # recordings in memory at a time
ORDERS = 12


def disturbance_beside_faults(clean: Path, disturbed: Path) -> tuple[pd.DataFrame, float]:
    """Mean amplitudes over recordings and gauges, and the largest relative change of an efficiency.

    Returns
    -------
    DataFrame
        ``source`` (``disturbance``: disturbed less clean recordings; or a fault: clean recordings less their healthy
        reference), ``order`` and ``amplitude`` [mV/V].
    float

    Raises
    ------
    ValueError
        If the data sets do not hold the same recordings, or were made by different code.
    """
    grid = disturbed.stem.removesuffix("-disturbed")
    require_same_code({path.stem: storage.attributes(path)["swgsim"] for path in (clean, disturbed)}, grid)
    bare = healthy_lines(storage.blocks(clean, BLOCK), ORDERS)
    with_noise = healthy_lines(storage.blocks(disturbed, BLOCK), ORDERS)
    same = ["gear", "label", "variant", "n_in_rpm", "T_out_nm"]
    if not bare.table[same].astype(str).equals(with_noise.table[same].astype(str)):
        raise ValueError(f"{clean} and {disturbed} hold other recordings: make both anew with the same grid")
    label = bare.table["label"].astype(str).to_numpy()
    shift = np.abs(bare.lines - bare.reference)
    sources = {"disturbance": np.abs(with_noise.lines - bare.lines)}
    sources |= {words(name): shift[label == name] for name in pd.unique(label) if name != "healthy"}
    rows = [
        (source, order, float(amplitude))
        for source, lines in sources.items()
        for order, amplitude in enumerate(lines.mean(axis=(0, 1)))
    ]
    change = (with_noise.table["efficiency"] / bare.table["efficiency"] - 1).abs().max()
    return pd.DataFrame(rows, columns=["source", "order", "amplitude"]), float(change)
