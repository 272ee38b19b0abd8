"""Zero of the recorded angle: in the model, the major axis of the wave generator is at gauge s1 there.

The zero of an encoder depends on its mounting. It is estimated from the healthy gear and subtracted from all
recordings. A zero that moved since then is refused, because it would look like an effect.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from swgsim.identification.data.features import Layout, features
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.checks.thresholds import ANGLE_ZERO
from swgsim.recordings.read import require_usable
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS


def zero_of(recordings: Sequence[Recording], model: Model) -> float:
    """Angle by which recordings are ahead of a gear [rad], up to half a turn; 0 if the spread of units may explain it.

    It is estimated from order 2 of s1 to s4, weighted by amplitude, so that errors of single gauges average out. With
    two lobes, half a turn remains ambiguous.

    Parameters
    ----------
    recordings : sequence of Recording
        With the same channels, ``phi_in`` among them.
    model : Model
        The nominal gear with the declared effects.
    """
    layout = Layout(tuple(sensor for sensor in SENSORS[1:] if sensor in recordings[0].channels))
    if not layout.channels:
        return 0.0
    situations = [Situation(each.point, each.conditions) for each in recordings]
    predicted = layout.lines(predict([model], situations, layout)[0])[..., 2]
    measured = layout.lines(np.array([features(each, layout) for each in recordings]))[..., 2]
    turned = predicted * measured.conj()
    ahead = float(np.angle(turned.sum())) / 2
    # Lobes turn with load, scanned channels lag with speed and one after another; a zero is off in every recording and
    # at every gauge alike: the least one counts.
    least = min(np.abs(np.angle(turned.sum(axis=axis))).min() for axis in (0, 1)) / 2
    return ahead if min(abs(ahead), least) > ANGLE_ZERO else 0.0


def from_zero(recordings: Sequence[Recording], zero: float) -> tuple[Recording, ...]:
    """Recordings with their angle counted from another zero [rad]."""
    return tuple(
        replace(each, channels={**each.channels, "phi_in": each.channels["phi_in"] - zero}) for each in recordings
    )


def zero_defects(recordings: Sequence[Recording], zero: float) -> Iterator[Defect]:
    """A warning that another zero was taken out, unless it is 0."""
    if zero:
        yield Defect(
            "angle_zero", "warn", recordings[0].name, "phi_in",
            f"an angle that is {zero:.3f} rad ahead of the gear's in all recordings, known up to half a turn",
            f"at most {ANGLE_ZERO:g} rad: zero where the major axis of the wave generator is at s1",
            f"{zero:.3f} rad were subtracted, from commissioning too; if it is the encoder's zero, say 'zero_rad: "
            f"{zero:.3f}' in a column map; by a quarter of a turn, the gauges may be inverted or numbered from another "
            "one",
        )  # fmt: skip


def require_same_zero(path: Path, recordings: Sequence[Recording], model: Model) -> None:
    """Raise a ValueError, with the angle, if recordings are ahead of a gear of which the zero is known."""
    if moved := zero_of(recordings, model):
        defect = Defect(
            "angle_zero", "refuse", recordings[0].name, "phi_in",
            f"an angle that is {moved:.3f} rad ahead of that of the commissioning, known up to half a turn",
            f"at most {ANGLE_ZERO:g} rad: the same zero",
            f"subtract {moved:.3f} rad, in the files or by 'zero_rad' in a column map of these recordings alone",
        )  # fmt: skip
        require_usable(path, [defect])
