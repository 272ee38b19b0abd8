"""Error of a fitted model where nothing was recorded, in the session in which the recordings were made.

What the instruments show there has the zeros of that session, as all its recordings have. They are no matter of the
gear, and the model that is judged expects them as the recordings tell them.
"""

import numpy as np
from jaxtyping import Float

from swgsim.blind.bench import UNSEEN
from swgsim.identification.fit.errors import size
from swgsim.identification.fit.fitted import Fitted

# The speed is set by the motor control; its ripple is not predicted.
JUDGED = ("T_in", "T_out", "s0", "s1", "s2", "s3", "s4")


def unseen_error(fitted: Fitted, truth: Float[np.ndarray, "situation feature"]) -> float:
    """Root mean square over channels of the error at the unseen points, each in shares of all that its channel did."""
    layout = fitted.measured.layout
    squares = (expected(fitted) - truth) ** 2 * np.where(layout.order == 0, 1.0, 0.5)
    means = fitted.measured.values[:, layout.order == 0]
    # A torque hardly ripples; what there is to predict is also how its mean differs between operating points.
    variance = size(fitted.measured) ** 2 + means.var(axis=0)
    shares = [
        squares[:, layout.channel == channel].sum(axis=1).mean() / variance[number]
        for number, channel in enumerate(layout.channels)
        if channel in JUDGED
    ]
    return float(np.sqrt(np.mean(shares)))


def expected(fitted: Fitted) -> Float[np.ndarray, "situation feature"]:
    """What a fitted model expects at the unseen points, with all that the recordings say about what it left open, of
    the gear and of their session, of which there is one.
    """
    measured = fitted.measured
    (session,) = measured.sessions
    situations = (*measured.situations, *UNSEEN)
    unsure = fitted.unit.left_open(fitted.model, situations, measured.layout, fitted.parameters)
    predicted, shift, left_open, _, J = (part[-len(UNSEEN) :] for part in unsure)
    mean = fitted.whole.common_mean(fitted.from_start)
    first = fitted.errors.columns.shape[1]
    found = mean[first : first + left_open.shape[-1]]
    # The model stands where its parameters were found to be; what they are counted from lies further back.
    beyond = mean[len(mean) - J.shape[-1] :] - np.array(list(fitted.calibrated.position.values()))
    instruments = measured.further(session, UNSEEN, predicted).session_columns(predicted, measured)
    shown = (instruments @ mean[:first]).reshape(predicted.shape)
    return predicted + shift + left_open @ found + J @ beyond + shown
