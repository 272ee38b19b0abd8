"""What a command is given: recordings to examine, and the healthy gear as recordings or as the file of a unit."""

import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from swgsim.effects.base import Effect
from swgsim.gear.gear import Gear
from swgsim.identification.calls import require_comparable, require_same_gear, with_channels
from swgsim.identification.data.features import COMPARED
from swgsim.identification.fit.unit import Unit
from swgsim.identification.fit.unit_file import is_unit_file
from swgsim.jobs import settings
from swgsim.recordings.files.manifest import NAME as MANIFEST
from swgsim.recordings.read import read_recordings
from swgsim.recordings.recording import Recording
from swgsim.recordings.recording_set import RecordingSet
from swgsim.tables.file_defect import read_for


class LoopInput(NamedTuple):
    """Recordings in question, nominal gear, declared effects, and the healthy gear if it is known.

    The healthy gear is known by recordings with the channels that those in question have too, or by its unit.
    """

    recordings: RecordingSet
    gear: Gear
    declared: tuple[Effect, ...]
    healthy: tuple[Recording, ...] | Unit | None


def source_of(config: Mapping[str, Any]) -> str:
    """Where the recordings are; raises a ValueError if none are given."""
    if config["recordings"] is None:
        raise ValueError("no recordings: give recordings=FOLDER, a folder with manifest.csv or a file of recordings")
    return str(config["recordings"])


def read_input(config: Mapping[str, Any]) -> LoopInput:
    """Read what the choices ``recordings``, ``commissioning``, ``gear`` and ``effects`` name.

    Raises
    ------
    ValueError
        If recordings cannot be used or do not belong together; the message says what to do.
    """
    source, healthy_source = source_of(config), config["commissioning"]
    say(f"reading {source}")
    recordings = _read(source, "recordings", config["mapping"])
    gear, declared = settings.gear(config["gear"]), settings.effects(config["effects"])
    if healthy_source is None:
        return LoopInput(recordings, gear, declared, None)
    if is_unit_file(Path(healthy_source)):
        return LoopInput(recordings, gear, declared, _kept(config))
    say(f"reading {healthy_source}")
    own_format = (Path(healthy_source) / MANIFEST).is_file()
    mapping = config["commissioning_mapping"] or (None if own_format else config["mapping"])
    healthy = _read(healthy_source, "commissioning", mapping)
    recordings = replace(recordings, defects=(*recordings.defects, *healthy.defects))
    return LoopInput(recordings, gear, declared, _comparable(recordings, healthy))


def _kept(config: Mapping[str, Any]) -> Unit:
    """The unit of a file.

    Raises
    ------
    ValueError
        If it cannot be read, or a choice is given that the unit has already.
    """
    path = config["commissioning"]
    for name in ("effects", "commissioning_mapping"):
        if config[name]:
            raise ValueError(f"{name}= is for recordings, commissioning={path} is a unit that has it: leave one out")
    say(f"reading {path}")
    return Unit.load(path)


def say(step: str) -> None:
    """Print a step on standard error."""
    print(step, file=sys.stderr, flush=True)


def _read(path: str, what: str, mapping: str | None) -> RecordingSet:
    """Recordings of one gear with the channels that an identification needs."""
    with read_for(what, path):
        recordings = read_recordings(path, mapping or None)
    require_comparable(recordings.recordings, f"{what}={path}")
    return recordings


def _comparable(recordings: RecordingSet, healthy: RecordingSet) -> tuple[Recording, ...]:
    """Recordings of the commissioning, with the channels that the recordings to examine have too.

    Raises
    ------
    ValueError
        If they are of different gears, share no channel, or one recording is in both.
    """
    one, other = recordings[0].channels, healthy[0].channels
    common = [name for name in one if name in other]
    if not set(common) & set(COMPARED):
        raise ValueError(
            f"recordings ({', '.join(one)}) and commissioning ({', '.join(other)}) share no channel besides the angle: "
            "record the same channels"
        )
    require_same_gear(recordings.recordings, healthy.recordings)
    return with_channels(healthy.recordings, common)
