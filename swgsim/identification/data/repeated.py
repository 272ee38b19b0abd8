"""Repeats: recordings of one session at the same operating point."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Inexact

from swgsim.recordings.recording import Recording


def groups_of(recordings: Sequence[Recording]) -> list[object]:
    """Session and operating point of each recording: those with the same ones are repeats of each other."""
    return [(each.session, each.point) for each in recordings]


def about_mean(values: Inexact[np.ndarray, "recording feature *more"], groups: Sequence[object]) -> np.ndarray:
    """Values less their mean over the repeats of each recording.

    >>> about_mean(np.array([[1.0], [3.0], [5.0]]), ["a", "a", "b"]).tolist()
    [[-1.0], [1.0], [0.0]]
    """
    number = [groups.index(each) for each in groups]
    means = {each: values[np.equal(number, each)].mean(axis=0) for each in number}
    return values - np.array([means[each] for each in number]).reshape(values.shape)


def freedom(groups: Sequence[object]) -> Float[np.ndarray, " recording"]:
    """Degrees of freedom that each recording adds to those of the repeats; 0 where nothing was repeated."""
    return np.array([1 - 1 / groups.count(each) for each in groups])
