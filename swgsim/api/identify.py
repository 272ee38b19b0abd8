"""One verb for gauges and for robot joints."""

from collections.abc import Iterable
from typing import Any, overload

from swgsim.gear import Gear
from swgsim.identification import Identification, Unit
from swgsim.identification import identify as identify_gear
from swgsim.joint import JointAnswer, JointRecordings, identify_joint
from swgsim.recordings import Recording


@overload
def identify(recordings: JointRecordings, **choices: Any) -> JointAnswer: ...


@overload
def identify(recordings: Iterable[Recording], unit: Unit | Gear, **choices: Any) -> Identification: ...


def identify(
    recordings: Iterable[Recording] | JointRecordings, unit: Unit | Gear | None = None, **choices: Any
) -> Identification | JointAnswer:
    """Find the physical effect that a model lacks.

    Parameters
    ----------
    recordings : iterable of Recording, or JointRecordings
        Of a gear with strain gauges (:func:`swgsim.read_recordings`), or of a robot (:func:`swgsim.recordings_of`).
    unit : Unit or Gear
        Of gauges only: a unit from :func:`swgsim.commission`, or a nominal gear that was not commissioned.
    choices
        Those of :func:`swgsim.identification.identify` (``effects``, ``interest``, ``seed``, ``progress``) or of
        :func:`swgsim.joint.identify_joint` (``joint``, ``signal``, ``holdout``, ``without``, ``searched`` ...).

    Returns
    -------
    Identification or JointAnswer
        Both have ``sentence``, ``report``, ``table()`` and ``save(folder)``.

    Raises
    ------
    ValueError
        If a unit is missing for gauges or given for a joint, or the recordings cannot be compared with the model.
    """
    if isinstance(recordings, JointRecordings):
        if unit is not None:
            raise ValueError("recordings of a robot joint need no unit: its textbook model is fitted; leave it out")
        return identify_joint(recordings, **choices)
    if unit is None:
        raise ValueError("recordings of gauges need a unit: commission(healthy_recordings, gear), or a nominal gear")
    return identify_gear(recordings, unit, **choices)
