"""Lack of fit to a healthy gear: lines that the model does not describe, and recordings of another gear."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.stats import chi2, false_discovery_control

from swgsim.identification.covariance.narrow_band import FALSE_DISCOVERIES
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.fitting import MISFIT
from swgsim.storage.labelled_signals import SENSORS

# Share of a channel's ripple that the model of a healthy gear may leave unexplained. With a larger share, the ripple
# does not belong to this gear if the mean square of one of its lines is also above MISFIT. If none is, the ripple is
# hardly more than noise, and a large share of it says nothing.
UNEXPLAINED_SHARE = 0.1


def lack_of_fit(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> Bool[np.ndarray, " feature"]:
    """Which lines the model misses significantly, in single recordings or in all of them alike.

    The gauges s1 to s4 have the same position relative to the lobes. So they are tested together, order by order.

    Parameters
    ----------
    measured : Measured
    missed : array (recording, feature)
        In declared standard deviations.
    """
    layout = measured.layout
    single, common = missed**2, len(missed) * missed.mean(axis=0) ** 2
    alike = np.array(["s1 to s4" if name in SENSORS[1:] else name for name in layout.channel])
    every = dict.fromkeys(zip(alike, layout.order, strict=True))
    lines = [(alike == channel) & (layout.order == order) for channel, order in every]
    by_single = [chi2.sf(single[:, line].sum(), single[:, line].size) for line in lines]
    in_common = [chi2.sf(common[line].sum(), line.sum()) for line in lines]
    significant = false_discovery_control([*by_single, *in_common]).reshape(2, -1) < FALSE_DISCOVERIES
    return np.array(lines)[significant.any(axis=0)].any(axis=0)


def unexplained(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> dict[str, float]:
    """Share of every channel's ripple that the model leaves unexplained, beyond noise; 0 where that is hardly more."""
    layout = measured.layout
    square = (missed**2).mean(axis=0)
    left = np.maximum(square - 1, 0) * measured.variance.mean(axis=0)
    power = (measured.values**2).mean(axis=0)
    shares = {}
    for channel in layout.channels:
        ripple = (layout.channel == channel) & (layout.order > 0)
        more = square[ripple].max() > MISFIT
        shares[channel] = float(np.sqrt(left[ripple].sum() / power[ripple].sum())) if more else 0.0
    return shares


def foreign_ripple(
    measured: Measured, missed: Float[np.ndarray, "recording feature"], most: float = UNEXPLAINED_SHARE
) -> Bool[np.ndarray, " feature"]:
    """Ripple of speed and torques that is not the model's, as where the torque is that of the brake: features of it.

    So it is where more than a share of it is unexplained.
    """
    layout, shares = measured.layout, unexplained(measured, missed)
    drive = [name for name, share in shares.items() if name not in SENSORS and share > most]
    return np.isin(layout.channel, drive) & (layout.order > 0)


def require_own(measured: Measured, missed: Float[np.ndarray, "recording feature"]) -> None:
    """Refuse a healthy gear if more than UNEXPLAINED of a channel's ripple is lack of fit."""
    shares = unexplained(measured, missed)
    poor = sorted(((share, name) for name, share in shares.items() if share > UNEXPLAINED_SHARE), reverse=True)
    if poor:
        differ = ", ".join(f"{name} ({100 * share:.0f} %)" for share, name in poor)
        raise ValueError(
            f"the model cannot be commissioned on these recordings: it leaves {differ} of the ripple unexplained, at "
            f"most {100 * UNEXPLAINED_SHARE:.0f} % may be. Correct the gear file (load inertia J_out, "
            "speed control), the zero of the angle or a channel of another gear, or leave that channel out"
        )
