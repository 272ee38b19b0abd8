"""Size of a fault: a quantity that grows with damage for every class, unlike some severities."""

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

# From severity to size, which is 0 without the fault: lost share of b1 and of k1, eccentricity [m], compliance that the
# crack adds to a tooth pitch of the rim, and lost share of the tooth force.
SIZES: Mapping[str, Callable[[np.ndarray], np.ndarray]] = {
    "reduced_damping": lambda remaining: 1 - remaining,
    "reduced_stiffness": lambda remaining: 1 - remaining,
    "eccentric_wave_generator": lambda eccentricity: eccentricity,
    "root_tooth_crack": lambda remaining: 1 / remaining - 1,
    "tip_tooth_crack": lambda lost: lost,
}
UNITS: Mapping[str, str] = {"eccentric_wave_generator": " m"}


def size(label: str, severity: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """Sizes of faults of one class from their severities, by :data:`SIZES`.

    Raises
    ------
    ValueError
        If the class is not a fault, or a size is not above 0, as evaluations need its logarithm.
    """
    if label not in SIZES:
        raise ValueError(f"{label!r} has no fault size; choose from {', '.join(SIZES)}")
    sizes = np.asarray(SIZES[label](severity))
    if not (sizes > 0).all():
        raise ValueError(f"{label}: a fault of size {sizes.min():g}, must be above 0; call such a specimen healthy")
    return sizes
