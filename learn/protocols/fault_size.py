"""The size of a fault: what grows with damage, whatever the severity of its class counts."""

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

# A class to its fault's size, which is 0 without the fault and grows with it: the lost share of b1 and of k1, the
# eccentricity [m], the compliance that the crack adds to a tooth pitch of the rim, and the lost share of tooth force.
SIZES: Mapping[str, Callable[[np.ndarray], np.ndarray]] = {
    "reduced_damping": lambda remaining: 1 - remaining,
    "reduced_stiffness": lambda remaining: 1 - remaining,
    "eccentric_wave_generator": lambda eccentricity: eccentricity,
    "root_tooth_crack": lambda remaining: 1 / remaining - 1,
    "tip_tooth_crack": lambda lost: lost,
}
UNITS: Mapping[str, str] = {"eccentric_wave_generator": " m"}


def size(label: str, severity: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """Size of the faults of one class from their severities, as :data:`SIZES` says.

    Raises
    ------
    ValueError
        If the class is no fault, or a size is not above 0, as its logarithm is needed.
    """
    if label not in SIZES:
        raise ValueError(f"{label!r} has no fault size; choose from {', '.join(SIZES)}")
    sizes = np.asarray(SIZES[label](severity))
    if not (sizes > 0).all():
        raise ValueError(f"{label}: a fault of size {sizes.min():g}, must be above 0; call such a specimen healthy")
    return sizes
