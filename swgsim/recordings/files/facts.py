"""Facts of a recording, from a manifest, the attributes of a file or a column map."""

from collections.abc import Mapping
from math import isfinite, nan

from swgsim.gear.conditions import REFERENCE_TEMPERATURE, Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.recording import Recording
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.text_stream import NUMBER

TEXTS = ("recording", "gear", "session")
NUMBERS = ("n_in_rpm", "T_out_nm")
NEEDED = (*TEXTS, *NUMBERS, "repeat")
OPTIONAL = ("temperature_c", "elapsed_s", "label")
KNOWN = (*NEEDED, *OPTIONAL)

LONGEST_TEXT = 200
MOST_REPEATS = 1_000_000


def parse(given: Mapping[str, object], file: str, row: int | None = None) -> dict[str, object]:
    """Facts with the right types and within their limits; missing optional ones get their defaults.

    Parameters
    ----------
    given : mapping
        Fact to text or number.
    file : str
        File that holds the facts.
    row : int, optional
        Its row.

    Raises
    ------
    FileDefect
        If a fact is missing, unknown, of the wrong type or beyond its limits.
    """
    missing = [name for name in NEEDED if name not in given]
    if missing:
        raise FileDefect(file, f"no {', '.join(missing)}", f"each of {', '.join(NEEDED)}", row)
    unknown = [name for name in given if name not in KNOWN]
    if unknown:
        raise FileDefect(file, f"unknown fact {shown(unknown[0])}", f"some of {', '.join(KNOWN)}", row)
    facts: dict[str, object] = {name: _text(given[name], file, row, name) for name in TEXTS}
    facts["label"] = _text(given.get("label", ""), file, row, "label", empty=True)
    defaults = {"temperature_c": REFERENCE_TEMPERATURE, "elapsed_s": 0.0}
    for name in (*NUMBERS, *defaults):
        facts[name] = _number(given.get(name, defaults.get(name)), file, row, name)
    repeat = _number(given["repeat"], file, row, "repeat")
    if not (repeat == int(repeat) and 1 <= repeat <= MOST_REPEATS):
        raise FileDefect(file, shown(given["repeat"]), f"a whole number from 1 to {MOST_REPEATS}", row, "repeat")
    facts["repeat"] = int(repeat)
    try:
        OperatingPoint(facts["n_in_rpm"], facts["T_out_nm"])  # type: ignore[arg-type]
        Conditions(facts["temperature_c"], facts["elapsed_s"])  # type: ignore[arg-type]
    except ValueError as error:
        raise FileDefect(file, f"a fact beyond its limits ({error})", "a value within them", row) from None
    return facts


def of(recording: Recording) -> dict[str, object]:
    """The facts of a recording, by name."""
    return {
        "recording": recording.name,
        "gear": recording.gear,
        "session": recording.session,
        "n_in_rpm": float(recording.point.n_in_rpm),
        "T_out_nm": float(recording.point.T_out),
        "repeat": int(recording.repeat),
        "temperature_c": float(recording.conditions.temperature),
        "elapsed_s": float(recording.conditions.elapsed),
        "label": recording.label,
    }


def _text(value: object, file: str, row: int | None, column: str, empty: bool = False) -> str:
    """Printable text without blanks around it; a whole number of a column map becomes text."""
    if isinstance(value, int) and not isinstance(value, bool):
        value = str(value)
    sound = isinstance(value, str) and value.isprintable() and value == value.strip() and len(value) <= LONGEST_TEXT
    if not sound or (not value and not empty):
        expected = f"printable text of at most {LONGEST_TEXT} characters without blanks around it"
        raise FileDefect(file, shown(value), expected, row, column)
    return str(value)


def _number(value: object, file: str, row: int | None, column: str) -> float:
    if isinstance(value, str) and NUMBER.fullmatch(value):
        value = float(value)
    try:
        number = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else nan
    except OverflowError:  # of an integer
        number = nan
    if not isfinite(number):
        raise FileDefect(file, shown(value), "a finite number; leave out the column if it is unknown", row, column)
    return number
