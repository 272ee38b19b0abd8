"""Errors before and after, in total and per channel, with intervals, and the noise floor."""

from typing import Any

import numpy as np
from jaxtyping import Float, Int
from scipy.stats import chi2

from swgsim.common.numbers import number
from swgsim.common.seeds import generator
from swgsim.identification.data.measured import Measured
from swgsim.identification.fit.errors import Errors, noise_floor, per_channel, relative, rms
from swgsim.identification.fit.fitted import Fitted
from swgsim.recordings.recording import CHANNELS

UNIT = "% of the root mean square of each channel, root mean square over the channels"
# Kinds of errors: fitted recordings, left-out repeats, left-out operating points.
WHAT = ("fit", "repeats", "heldout")
CONFIDENCE, RESAMPLES = 0.95, 2000
# Smallest number of operating points for a bootstrap; with three or four its intervals are far too narrow.
FEWEST_POINTS = 5
TAILS = np.array([(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])


def overall(measured: Measured, error: Float[np.ndarray, "*recording channel"]) -> float | None:
    """One number for all channels and recordings [UNIT]; None if it is unknown."""
    return number(100 * relative(measured, error))


def named(measured: Measured, error: Float[np.ndarray, " channel"]) -> dict[str, float | None]:
    """The error of every channel by its name, in the channel's unit."""
    return {name: number(value) for name, value in zip(measured.layout.channels, error.tolist(), strict=True)}


def heldout(before: Fitted, after: Fitted) -> dict[str, float | None]:
    """Errors of both at recorded operating points, each by the model fitted to the others, as the report has them."""
    both = {"before": before, "after": after}
    return {name: overall(each.measured, Errors(each, after).heldout) for name, each in both.items()}


def error(before: Fitted, after: Fitted) -> dict[str, Any]:
    """Errors before and after, of what was fitted and of what was left out, what they fell by, and the noise floor."""
    measured = before.measured
    floor, scale = noise_floor(measured), per_channel(measured, measured.values.ravel())
    both = {"before": Errors(before, after), "after": Errors(after, after)}
    found = {name: {what: getattr(each, what) for what in WHAT} for name, each in both.items()}
    said = {name: {what: overall(measured, each) for what, each in of.items()} for name, of in found.items()}
    noise, points = overall(measured, floor), _points(measured)
    interval = _of_floor(noise, measured.spare)
    return {
        **said,
        "after_over_before": {
            what: _ratio(found["after"][what] / scale, found["before"][what] / scale, points) for what in WHAT
        },
        "explained": {what: _explained(said["before"][what], said["after"][what], noise, interval) for what in WHAT},
        "noise_floor": noise,
        "noise_floor_ci95": interval,
        "unit": UNIT,
        "per_channel": {
            channel: {
                **{name: {what: number(rms(each[:, i])) for what, each in of.items()} for name, of in found.items()},
                "noise_floor": number(floor[i]),
                "root_mean_square": number(scale[i]),
                "unit": CHANNELS[channel].unit,
            }
            for i, channel in enumerate(measured.layout.channels)
        },
    }


def _points(measured: Measured) -> Int[np.ndarray, " recording"]:
    """The number of the operating point of every recording."""
    points = [recording.point for recording in measured.recordings]
    return np.array([points.index(point) for point in points])


def _ratio(
    after: Float[np.ndarray, "recording channel"],
    before: Float[np.ndarray, "recording channel"],
    points: Int[np.ndarray, " recording"],
) -> dict[str, Any]:
    """What errors are to those before, with the interval of a bootstrap over operating points, as what a model lacks is
    the same in all recordings of one; no interval of a few of them, nor where nothing was added.
    """
    known = np.isfinite(before).all(axis=1)
    squares = np.array(
        [
            [(error[known & (points == point)] ** 2).sum() for error in (after, before)]
            for point in dict.fromkeys(points[known].tolist())
        ]
    )  # (point, after and before)
    if not len(squares) or not squares[:, 1].any():
        return {"value": None, "ci95": None}
    value, interval = float(np.sqrt(np.divide(*squares.sum(axis=0)))), None
    if len(squares) >= FEWEST_POINTS and (after != before)[known].any():
        drawn = generator("bootstrap of an error").integers(len(squares), size=(RESAMPLES, len(squares)))
        interval = np.quantile(np.sqrt(np.divide(*squares[drawn].sum(axis=1).T)), TAILS).tolist()
    return {"value": value, "ci95": interval}


def _explained(
    before: float | None, after: float | None, floor: float | None, interval: list[float] | None
) -> float | None:
    """Share of the squared error beyond noise that is gone; None where there was none clearly beyond it."""
    if before is None or after is None or floor is None or interval is None or before <= interval[1]:
        return None
    return (before**2 - after**2) / (before**2 - floor**2)


def _of_floor(floor: float | None, spare: int) -> list[float] | None:
    """Interval of a noise floor by so many spare recordings, each of which counts once: its errors go together."""
    return None if floor is None else [floor * float(np.sqrt(spare / chi2.ppf(tail, spare))) for tail in TAILS[::-1]]
