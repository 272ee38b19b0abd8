"""Scatter of a fault's signature by the errors of load and trigger."""

import numpy as np
from jaxtyping import Float

from swgsim.bench.scatter import Bench
from swgsim.oracle.cells import Cells
from swgsim.oracle.model import ORDERS
from swgsim.storage.labelled_signals import SENSORS


def with_recording_errors(cells: Cells, bench: Bench) -> Cells:
    """Cells whose change varies between recordings, by two more directions: it follows the load, and the trigger.

    A large fault changes lines by hundreds of standard deviations of the noise, of which a load error of 0.5 % and a
    turned trigger leave several. Classes are told apart without this; severities would seem surer than they are.
    """
    more = np.stack([bench.load * cells.shift, bench.index_angle * _turned(cells.shift)], axis=1)
    return Cells(cells.shift, np.concatenate([cells.spread, more], axis=1))


def _turned(change: Float[np.ndarray, "cell feature"]) -> Float[np.ndarray, "cell feature"]:
    """Change of a change by a radian by which the trigger comes late: i k times the line of order k."""
    means = len(SENSORS) * (ORDERS + 1)
    real = change[:, :means].reshape(len(change), len(SENSORS), ORDERS + 1)
    imaginary = change[:, means:-2].reshape(len(change), len(SENSORS), ORDERS)
    k = np.arange(ORDERS + 1)
    of_real = np.concatenate([np.zeros_like(real[:, :, :1]), -k[1:] * imaginary], axis=2)
    of_imaginary = k[1:] * real[:, :, 1:]
    found = np.zeros_like(change)
    found[:, :means], found[:, means:-2] = of_real.reshape(len(change), -1), of_imaginary.reshape(len(change), -1)
    return found
