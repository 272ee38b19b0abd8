"""Whether a line keeps its phase: what one half of a run says of it, held against the other half."""

import numpy as np
from jaxtyping import Float

from swgsim.joint.recording import JointRecording

# Frequencies between two that half of a run resolves.
FINER = 16


def foretold(
    recording: JointRecording, residual: Float[np.ndarray, " time"], fixed: float, order: float, doubt: float
) -> Float[np.ndarray, " time"]:
    """What is left of each half of a run when a line is taken out as the other half shows it.

    Amplitude, phase and exact frequency of every run are its own, as those of a clock that was not recorded are: taken
    from one half they lower the error of the other if the line keeps its phase, and raise it if not.

    Parameters
    ----------
    recording : JointRecording
    residual : array (time,)
    fixed, order : float
        The line's frequency is fixed + order * speed / (2 pi) [Hz].
    doubt : float
        By which it may be off [Hz].
    """
    time = np.arange(len(residual)) / recording.rate
    way = recording.signals["q"] * np.sign(recording.speed.mean())
    wave = np.exp(1j * (2 * np.pi * fixed * time + order * way))
    left = residual.copy()
    halves = np.array_split(np.arange(len(residual)), 2)
    for known, unknown in (halves, halves[::-1]):
        number = FINER * len(known)
        sizes = 2 / len(known) * np.fft.fft((residual * wave.conj())[known], number)
        off = np.fft.fftfreq(number, 1 / recording.rate)
        best = int(np.where(np.abs(off) <= doubt, np.abs(sizes), -1.0).argmax())
        turned = np.exp(2j * np.pi * off[best] * (time - time[known[0]]))
        left[unknown] -= (sizes[best] * turned * wave).real[unknown]
    return left
