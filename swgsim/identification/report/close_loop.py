"""The command ``swg close-loop``: recordings in, the answer out as a folder."""

import hashlib
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from swgsim.bench import truth
from swgsim.common.files import require_writable
from swgsim.common.numbers import significant
from swgsim.common.outcome import NOTHING, Outcome
from swgsim.common.style import words
from swgsim.dataset.faults import FAULTS
from swgsim.effects.base import Effect
from swgsim.effects.library import SEARCHED, listed, named
from swgsim.effects.line_between import LineBetween
from swgsim.effects.regularity import Regularity
from swgsim.effects.text import from_entries
from swgsim.identification.calls import commission, identify, nominal_unit
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.effect_words import effect_in_words, effect_text
from swgsim.identification.report.engineering_units import value_text
from swgsim.identification.report.loop_input import read_input, say, source_of
from swgsim.recordings.recording import Recording


def run(config: Mapping[str, Any]) -> Outcome:
    """Write ``report.json``, ``effects.yaml`` and ``page.html`` into the folder ``out``, and print the answer.

    Steps are printed on standard error while they run.

    Raises
    ------
    ValueError
        If recordings cannot be used, do not belong together, or a choice is unknown; the message says what to do.
    OSError
        If the folder ``out`` cannot be written.
    KeyboardInterrupt
        With a message: the answer is written at the end, so an interrupted command keeps nothing.
    """
    try:
        return _run(config)
    except KeyboardInterrupt:
        raise KeyboardInterrupt("interrupted; nothing is kept, since the answer is written at the end") from None


def _run(config: Mapping[str, Any]) -> Outcome:
    start = time.perf_counter()
    source = source_of(config)
    kinds = library(config)
    require_writable(Path(config["out"]))
    hidden = None if config["truth"] is None else _hidden(Path(config["truth"]), source)
    recordings, gear, declared, healthy = read_input(config)
    if healthy is None:
        unit = nominal_unit(gear, declared)
    elif isinstance(healthy, Unit):
        unit = healthy
    else:
        unit = commission(healthy, gear, declared=declared, progress=say)
    found = identify(recordings, unit, effects=kinds, interest=config["interest"], seed=config["seed"], progress=say)
    report = {
        **found.report,
        "made": {**found.report["made"], "commissioning": config["commissioning"]},
        "seconds": round(time.perf_counter() - start, 1),
        **({} if hidden is None else {"hidden": hidden}),
    }
    found = replace(found, report=report)
    say(f"writing {config['out']}")
    found.save(config["out"])
    print("\n".join(lines(report)))
    return Outcome(report, found.pictures, digest(recordings))


def library(config: Mapping[str, Any]) -> tuple[type[Effect], ...]:
    """The effects that are searched: the named ones or the whole library, and further ones from outside.

    Raises
    ------
    ValueError
        If an effect is unknown or cannot be searched.
    """
    searched = SEARCHED if config["searched"] is None else tuple(map(named, listed(config["searched"])))
    kinds = tuple(dict.fromkeys((*searched, *map(named, listed(config["library"])))))
    nameless = [kind.name() for kind in kinds if issubclass(kind, (Regularity, LineBetween))]
    if nameless:
        raise ValueError(
            f"{', '.join(nameless)} cannot be searched: an identification describes an unknown remainder by it; leave "
            "it out of searched= and library="
        )
    return kinds


def lines(report: Mapping[str, Any]) -> list[str]:
    """The printed answer: the sentence, the errors and the effects."""
    error = report["error"]
    shown = [
        report["sentence"],
        f"error before   {_errors(error['before'])}",
        f"error after    {_errors(error['after'])}",
        f"noise floor    {_percent(error['noise_floor'])}{_interval(error['noise_floor_ci95'])}",
    ]
    shown += [f"effect found   {effect_text(each['name'], each['parameters'])}" for each in report["effects"]]
    if report["verdict"] == NOTHING:
        shown.append(f"detected from  {_detection_limits(report['detectable'])}; all others are in the report")
    if "hidden" in report:
        shown.append(f"effect hidden  {report['hidden']}")
    return shown


def _detection_limits(detectable: Mapping[str, Mapping[str, Any]]) -> str:
    """The detection limits of the five faults."""
    limits = {name: detectable[name] for name in FAULTS if name in detectable}
    known = {name: each for name, each in limits.items() if each["value"] is not None}
    return (
        ", ".join(f"{words(name)} ({value_text(name, e['parameter'], e)})" for name, e in known.items()) or "no fault"
    )


def _errors(error: Mapping[str, float | None]) -> str:
    left_out = {"left-out repeats": error["repeats"], "left-out operating points": error["heldout"]}
    return ", ".join([_percent(error["fit"]), *(f"{name} {_percent(each)}" for name, each in left_out.items())])


def _interval(interval: Sequence[float] | None) -> str:
    return "" if interval is None else f" (95 %: {significant(interval[0])} to {significant(interval[1])})"


def _percent(value: float | None) -> str:
    return significant(value) + ("" if value is None else " %")


def digest(recordings: Iterable[Recording]) -> str:
    """Sixteen hexadecimal digits that change with the recordings."""
    digest_ = hashlib.sha256()
    for each in recordings:
        digest_.update(f"{each.name} {each.session} {each.point} {each.conditions}".encode())
        digest_.update(each.numbers.encode())
    return digest_.hexdigest()[:16]


def _hidden(path: Path, recordings: str) -> str:
    """The hidden effects in words, from the truth of a virtual test bench; a seal is verified.

    Raises
    ------
    ValueError
        If the file is not a truth, or not the sealed one.
    """
    if not path.is_file():
        raise ValueError(f"truth={path} does not exist; swg record writes it next to the folder of recordings")
    try:
        hidden = from_entries(_truth(path, Path(recordings))["hidden"])
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"truth={path} is not a truth of swg record: it has no list 'hidden' ({error})") from error
    return " and ".join(map(effect_in_words, hidden)) or "none"


def _truth(path: Path, folder: Path) -> Mapping[str, Any]:
    """The content of a truth; for a folder with a seal, only of the sealed one."""
    expected = truth.truth_of(folder)
    own, sealed = path.resolve() == expected.resolve(), (folder / truth.SEAL).is_file()
    if sealed and not own and not truth.vouched(folder, path.read_bytes()):
        raise ValueError(f"truth={path} does not belong to the seal {folder / truth.SEAL}: give {expected}")
    return truth.open_truth(folder, path) if own or sealed else truth.parsed(path, path.read_bytes())
