"""Whether the recorded angle is zero where the model has it: the major axis of the wave generator at gauge s1."""

from collections.abc import Iterator, Sequence

import numpy as np

from swgsim.defects.defect import Defect
from swgsim.defects.thresholds import ANGLE_ZERO
from swgsim.loop.features import Layout, features
from swgsim.loop.model import Model, Situation, predict
from swgsim.recording import Recording
from swgsim.recordings import SENSORS


def zero_defects(recordings: Sequence[Recording], model: Model) -> Iterator[Defect]:
    """The angle by which all recordings are ahead of a gear, if no unit of the gear explains it.

    From order 2 of s1 to s4, each weighed by its amplitude, so that errors of single gauges average out. Two lobes tell
    it up to half a turn, and no odd order helps: those of a unit have phases of their own.

    Parameters
    ----------
    recordings : sequence of Recording
        With the same channels, ``phi_in`` among them.
    model : Model
        The nominal gear with what is declared.
    """
    layout = Layout(tuple(sensor for sensor in SENSORS[1:] if sensor in recordings[0].channels))
    if not layout.channels:
        return
    situations = [Situation(each.point, each.conditions) for each in recordings]
    predicted = layout.lines(predict([model], situations, layout)[0])[..., 2]
    measured = layout.lines(np.array([features(each, layout) for each in recordings]))[..., 2]
    turned = predicted * measured.conj()
    ahead = float(np.angle(turned.sum())) / 2
    # Lobes turn with load, scanned channels lag with speed and one after another; a zero is off in every recording and
    # at every gauge alike: the least one counts.
    least = min(np.abs(np.angle(turned.sum(axis=axis))).min() for axis in (0, 1)) / 2
    if min(abs(ahead), least) > ANGLE_ZERO:
        yield Defect(
            "angle_zero", "refuse", recordings[0].name, "phi_in",
            f"an angle that is {ahead:.3f} rad ahead of the gear's in all recordings, known up to half a turn",
            f"at most {ANGLE_ZERO:g} rad: zero where the major axis of the wave generator is at s1",
            f"subtract {ahead:.3f} rad, in the files or by 'zero_rad: {ahead:.3f}' in a column map, from recordings "
            "and commissioning alike; by a quarter of a turn, the gauges may be inverted or numbered from another one",
        )  # fmt: skip
