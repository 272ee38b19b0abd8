"""Errors on held-out recordings within and beyond the speeds of the fitted recordings."""

from typing import Any

import numpy as np

from swgsim.joint.regression import rms
from swgsim.joint.validation import Validation


def by_speed(validation: Validation) -> dict[str, Any]:
    """Highest fitted speed [rad/s]; errors of both models up to it and above, and the share of samples above.

    Errors of a range without samples are None.
    """
    fitted, held = (
        np.concatenate([np.abs(each.speed) for each in table.recordings])
        for table in (validation.table, validation.heldout)
    )
    highest = float(fitted.max())
    beyond = held > highest
    ladder = validation.ladder
    missed = {
        name: fit.missed(validation.heldout) for name, fit in (("before", ladder.textbook), ("after", ladder.top))
    }
    return {
        "fitted_up_to": highest,
        "share_beyond": float(beyond.mean()),
        "within": {name: rms(each[~beyond]) for name, each in missed.items()} if (~beyond).any() else None,
        "beyond": {name: rms(each[beyond]) for name, each in missed.items()} if beyond.any() else None,
    }
