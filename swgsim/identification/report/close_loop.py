"""The job of scripts/close_loop.py: recordings in, the answer out as a folder."""

import hashlib
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from threadpoolctl import threadpool_limits

from swgsim.common.outcome import NOTHING, Outcome
from swgsim.jobs import settings
from swgsim.bench import truth
from swgsim.recordings.checks.defect import Defect
from swgsim.effects.base import Effect
from swgsim.effects.library import SEARCHED, listed, named
from swgsim.effects.line_between import LineBetween
from swgsim.effects.regularity import Regularity
from swgsim.effects.text import as_text, sized
from swgsim.dataset.faults import FAULTS
from swgsim.common.files import require_writable, write_json, write_text
from swgsim.recordings.files.file_defect import read_for
from swgsim.recordings.read import read_recordings, require_usable
from swgsim.identification.data.angle_zero import from_zero, require_same_zero, zero_defects, zero_of
from swgsim.identification.report.answer import Answer, answer
from swgsim.common.outcome import NOTHING
from swgsim.identification.commissioning.commissioning import commission
from swgsim.identification.report.next_experiment import next_experiments
from swgsim.identification.data.features import COMPARED
from swgsim.identification.data.gauge_order import order_defects
from swgsim.identification.data.model import Model
from swgsim.identification.report.answer_page import page
from swgsim.common.numbers import significant
from swgsim.identification.report.report_fields import report
from swgsim.identification.data.measured import Measured
from swgsim.identification.interharmonics.named_interharmonics import has_sidelines
from swgsim.identification.fit.unit import Unit
from swgsim.recordings.recording import Recording
from swgsim.common.style import words

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@threadpool_limits.wrap(limits=1)  # so that bytes do not depend on the cores, nor seconds on who else uses them
def run(config: Mapping[str, Any]) -> Outcome:
    """Write ``report.json``, ``effects.yaml`` and ``page.html`` into the folder ``out``, and print the answer.

    Raises
    ------
    ValueError
        If recordings cannot be used, do not belong together, or a choice is unknown; it says what to do.
    OSError
        If the folder ``out`` cannot be written.
    """
    start = time.perf_counter()
    if config["recordings"] is None:
        raise ValueError("no recordings: give recordings=FOLDER, a folder with manifest.csv or a file of recordings")
    kinds = library(config)
    require_writable(Path(config["out"]))
    hidden = None if config["truth"] is None else _hidden(Path(config["truth"]), config["recordings"])
    recordings, defects = _read(config["recordings"], "recordings", config["mapping"])
    declared = settings.effects(config["effects"])
    between = tuple(effect for effect in declared if has_sidelines(type(effect)))
    unit = Unit(Model(settings.gear(config["gear"]), tuple(e for e in declared if e not in between)))
    if config["commissioning"] is None:
        zero = zero_of(recordings, unit.model)
        recordings = from_zero(recordings, zero)
    else:
        mapping = config["commissioning_mapping"] or config["mapping"]
        healthy, more = _read(config["commissioning"], "commissioning", mapping)
        recordings, healthy = _alike(recordings, healthy)
        zero = zero_of(healthy, unit.model)
        recordings, healthy = from_zero(recordings, zero), from_zero(healthy, zero)
        require_same_zero(Path(config["recordings"]), recordings, unit.model)
        require_usable(Path(config["recordings"]), order_defects(recordings, healthy))
        defects = (*defects, *more)
        unit = commission(Measured.of(healthy), unit)
    defects = (*defects, *zero_defects(recordings, zero))
    found = answer(recordings, unit, kinds, known=between, seed=config["seed"])
    said = report(found, kinds, next_experiments(found), defects, time.perf_counter() - start)
    if hidden is not None:
        said = {**said, "hidden": hidden}
    figures = write(Path(config["out"]), found, said)
    print("\n".join(lines(said)))
    return Outcome(said, figures, digest(recordings))


def library(config: Mapping[str, Any]) -> tuple[type[Effect], ...]:
    """The effects that are searched for: those named, or all of the library, and further ones from outside.

    Raises
    ------
    ValueError
        If one is none that can be, or cannot be searched for.
    """
    searched = SEARCHED if config["searched"] is None else tuple(map(named, listed(config["searched"])))
    kinds = tuple(dict.fromkeys((*searched, *map(named, listed(config["library"])))))
    nameless = [kind.name() for kind in kinds if issubclass(kind, (Regularity, LineBetween))]
    if nameless:
        raise ValueError(
            f"{', '.join(nameless)} cannot be searched for: a loop writes it where no effect explains the recordings; "
            "leave it out of searched= and library="
        )
    return kinds


def write(folder: Path, found: Answer, said: Mapping[str, Any]) -> dict[str, "Figure"]:
    """Write the answer; every file is complete or absent. Returns the pictures."""
    from swgsim.identification.report.answer_figures import pictures  # with matplotlib, which takes a second

    drawn = pictures(found, said)
    html = page(said, [picture for picture, _ in drawn.values()])
    beside = (*found.known, *(line.effect for line in found.lines), *found.bare_lines)
    write_json(folder / "report.json", said)
    write_text(folder / "effects.yaml", as_text((*found.closed.after.model.effects, *beside)))
    write_text(folder / "page.html", html)
    return {name: each for name, (_, each) in drawn.items()}


def lines(said: Mapping[str, Any]) -> list[str]:
    """What the command prints: the sentence, then the figures."""
    error = said["error"]
    found = [
        f"{words(effect['name'])} ({', '.join(_parameter(*each) for each in effect['parameters'].items())})"
        for effect in said["effects"]
    ]
    shown = [
        said["sentence"],
        f"error before   {_both(error['before'])}",
        f"error after    {_both(error['after'])}",
        f"noise floor    {_percent(error['noise_floor'])}{_between(error['noise_floor_ci95'])}",
        f"effect found   {' and '.join(found) or 'none'}",
    ]
    if said["verdict"] == NOTHING:
        shown.append(f"would be seen  {_smallest(said['detectable'])}; all others are in the report")
    if "hidden" in said:
        shown.append(f"effect hidden  {said['hidden']}")
    return shown


def _smallest(detectable: Mapping[str, Mapping[str, Any]]) -> str:
    """The smallest size of each of the five faults that would have been seen."""
    seen = {words(name): detectable[name] for name in FAULTS if name in detectable}
    known = {name: each for name, each in seen.items() if each["value"] is not None}
    return ", ".join(f"{name} ({_parameter(each['parameter'], each)})" for name, each in known.items()) or "no fault"


def _both(error: Mapping[str, float | None]) -> str:
    left_out = {"repeats": error["repeats"], "operating points": error["heldout"]}
    return ", ".join([_percent(error["fit"]), *(f"of {name} left out {_percent(e)}" for name, e in left_out.items())])


def _between(interval: Sequence[float] | None) -> str:
    return "" if interval is None else f" (95 %: {significant(interval[0])} to {significant(interval[1])})"


def _percent(value: float | None) -> str:
    return significant(value) + ("" if value is None else " %")


def _parameter(name: str, estimate: Mapping[str, Any]) -> str:
    return sized(name, significant(estimate["value"]), estimate["unit"])


def digest(recordings: Sequence[Recording]) -> str:
    """Sixteen hexadecimal digits that change when a recording does."""
    made = hashlib.sha256()
    for each in recordings:
        made.update(f"{each.name} {each.session} {each.point} {each.conditions}".encode())
        for name in sorted(each.channels):
            made.update(name.encode() + each.channels[name].tobytes())
    return made.hexdigest()[:16]


def _read(path: str, what: str, mapping: str | None) -> tuple[tuple[Recording, ...], tuple[Defect, ...]]:
    """Recordings of one gear with what the loop needs."""
    with read_for(what, path):
        found = read_recordings(path, mapping or None)
    recordings, defects = found.recordings, found.defects
    gears = list(dict.fromkeys(recording.gear for recording in recordings))
    if len(gears) > 1:
        raise ValueError(
            f"{what}={path} holds recordings of the gears {', '.join(gears)}: a loop is closed for one gear, put each "
            "into a folder of its own"
        )
    channels = recordings[0].channels
    if "phi_in" not in channels:
        raise ValueError(
            f"{what}={path} has no phi_in_rad, the angle of the wave generator, against which everything is compared: "
            "record it, or integrate the speed from an index pulse"
        )
    if not set(channels) & set(COMPARED):
        raise ValueError(f"{what}={path} has nothing beside the angle: record at least one of {', '.join(COMPARED)}")
    return recordings, defects


def _alike(
    recordings: Sequence[Recording], healthy: Sequence[Recording]
) -> tuple[tuple[Recording, ...], tuple[Recording, ...]]:
    """Recordings and those of the commissioning with the channels that both have.

    Raises
    ------
    ValueError
        If they are of different gears, share no channel, or one is in both.
    """
    one, other = recordings[0], healthy[0]
    if one.gear != other.gear:
        raise ValueError(
            f"the recordings are of gear {one.gear!r}, those of the commissioning of {other.gear!r}: commission the "
            "same gear, or correct the name in the manifest"
        )
    common = [name for name in one.channels if name in other.channels]
    if not set(common) & set(COMPARED):
        raise ValueError(
            f"recordings ({', '.join(one.channels)}) and commissioning ({', '.join(other.channels)}) share no channel "
            "beside the angle: record the same ones"
        )
    recordings, healthy = _only(recordings, common), _only(healthy, common)
    _require_apart(recordings, healthy)
    return recordings, healthy


def _require_apart(recordings: Sequence[Recording], healthy: Sequence[Recording]) -> None:
    """Raise a ValueError if a recording is in both: what it shows would be taken for what the gear has always had."""
    there = {each.numbers: each.name for each in healthy}
    for each in recordings:
        if each.numbers in there:
            raise ValueError(
                f"recording {each.name} is in both recordings=... and commissioning=..., there as "
                f"{there[each.numbers]}: all that it shows would be learned as healthy, give recordings of the healthy "
                "state"
            )


def _only(recordings: Sequence[Recording], names: Sequence[str]) -> tuple[Recording, ...]:
    return tuple(replace(each, channels={name: each.channels[name] for name in names}) for each in recordings)


def _hidden(path: Path, recordings: str) -> str:
    """What was hidden, in words, from the truth of a virtual test bench; a seal that is there is checked.

    Raises
    ------
    ValueError
        If the file is no truth, or not the one that was sealed.
    """
    if not path.is_file():
        raise ValueError(f"truth={path} does not exist; scripts/record.py writes it beside the folder of recordings")
    try:
        told = _told(path, Path(recordings))
        effects = [(name, values.items()) for entry in told["hidden"] for name, values in entry.items()]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"truth={path} is no truth of scripts/record.py: it has no list 'hidden' ({error})") from error
    named_ = [f"{words(name)} ({', '.join(f'{k} {v}' for k, v in values)})" for name, values in effects]
    return " and ".join(named_) or "none"


def _told(path: Path, folder: Path) -> Mapping[str, Any]:
    """What a truth says; only of a folder without a seal may it be any."""
    beside = truth.truth_of(folder)
    own, sealed = path.resolve() == beside.resolve(), (folder / truth.SEAL).is_file()
    if sealed and not own and not truth.vouched(folder, path.read_bytes()):
        raise ValueError(f"truth={path} is not the one that {folder / truth.SEAL} was written for: give {beside}")
    return truth.open_truth(folder, path) if own or sealed else truth.parsed(path, path.read_bytes())
