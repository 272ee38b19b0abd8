"""What the names of the files of a folder say: facts, sessions, repeats, and files of single signals."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from swgsim.drafting.vocabulary import WORDS
from swgsim.drafting.words import words_of

# Parts of a path: words, numbers and single signs.
PART = re.compile(r"[^\W\d_]+|\d+(?:\.\d+)?|.")
NUMBER = re.compile(r"\d+(?:\.\d+)?")
# What a number is by the letters behind or before it.
BEHIND = {"rpm": "n_in_rpm", "upm": "n_in_rpm", "nm": "T_out_nm", "degc": "temperature_c"}
BEFORE = {"n": "n_in_rpm", "t": "T_out_nm", "rep": "repeat", "repeat": "repeat", "run": "repeat", "wdh": "repeat"}
SIGNALS = ("angle", "speed", "torque", "current", "time")


class FileNames(NamedTuple):
    """What names of files say.

    Attributes
    ----------
    path : str
        Regular expression of all names with groups; empty if they say nothing.
    groups : tuple of str
    """

    path: str
    groups: tuple[str, ...]


def signals_of(names: Sequence[str]) -> dict[str, dict[str, str]]:
    """Files of single signals: run to signal to file; empty if the files are not of this kind.

    >>> signals_of(["r1_position.csv", "r1_velocity.csv"])
    {'r1_': {'position': 'r1_position.csv', 'velocity': 'r1_velocity.csv'}}
    """
    found: dict[str, dict[str, str]] = {}
    for name in names:
        place, _, file = name.rpartition("/")
        stem = file.partition(".")[0]
        signal = re.split(r"[_\-. ]", stem)[-1]
        words, _ = words_of(signal)
        if not any(word in WORDS[kind] for word in words for kind in SIGNALS):
            return {}
        before = f"{place}/" * bool(place) + stem.removesuffix(signal)
        found.setdefault(before, {})[signal] = name
    sets = [tuple(sorted(files)) for files in found.values()]
    return found if len(sets[0]) > 1 and len(set(sets)) == 1 else {}


def signals_path(names: Sequence[str], kind: str) -> FileNames:
    """The path of files of single signals."""
    ending = re.escape("." + names[0].rsplit("/", 1)[-1].partition(".")[2])
    runs = signals_of(names)
    run = r"(?P<run>.+?)_?" if kind == "joints" and all(runs) else r"(?P<recording>.+?)_?" if all(runs) else ""
    signal = "|".join(map(re.escape, sorted({signal for files in runs.values() for signal in files})))
    return FileNames(
        f"{run}(?P<signal>{signal}){ending}", tuple(each for each in ("run", "signal") if each in run + "signal")
    )


def fact_names(names: Sequence[str]) -> FileNames:
    """A path with the facts of gauges that the names of all files say; empty if they differ in their form.

    >>> fact_names(["2000rpm_39Nm_1.csv", "1000rpm_39Nm_1.csv"]).path
    '(?P<n_in_rpm>\\\\d+(?:\\\\.\\\\d+)?)rpm_(?P<T_out_nm>\\\\d+(?:\\\\.\\\\d+)?)Nm_(?P<repeat>\\\\d+)\\\\.csv'
    """
    rows = [PART.findall(name) for name in names]
    if len({tuple("0" if NUMBER.fullmatch(part) else part.isalpha() for part in row) for row in rows}) != 1:
        return FileNames("", ())
    columns = list(zip(*rows, strict=True))
    stem = len(rows[0]) - rows[0][::-1].index(".") - 1 if "." in rows[0] else len(rows[0])
    groups: dict[int, str] = {}
    for place, parts in enumerate(columns[:stem]):
        if NUMBER.fullmatch(parts[0]):
            behind = next(iter(columns[place + 1]), "").lower() if place + 1 < len(columns) else ""
            before = next(
                (columns[each][0].lower() for each in range(place - 1, -1, -1) if columns[each][0].isalpha()), ""
            )
            near = place > 0 and columns[place - 1][0].lower() == before
            group = BEHIND.get(behind) or (
                BEFORE.get(before) if near or before in ("rep", "run", "wdh", "repeat") else None
            )
            if group and group not in groups.values():
                groups[place] = group
    varying = [place for place, parts in enumerate(columns[:stem]) if len(set(parts)) > 1 and place not in groups]
    # A number at the end of a name is that of a repeat, if it differs or the other numbers have a meaning.
    end = stem - 1
    if (
        columns[end][0].isdigit()
        and end not in groups
        and "repeat" not in groups.values()
        and (groups or end in varying)
    ):
        groups[end] = "repeat"
        varying = [place for place in varying if place != end]
    text = ""
    folder_end = max((place for place, parts in enumerate(columns[:stem]) if parts[0] == "/"), default=-1)
    if any(place < folder_end for place in varying):
        text = r"(?P<session>[^/]+)/"
        groups[-1] = "session"
        if any(parts[0] == "/" for parts in columns[:folder_end]):
            text = r"(?:.*/)?" + text
        start = folder_end + 1
    else:
        start = 0
    for place in range(start, len(columns)):
        parts = columns[place]
        if place in groups:
            form = r"\d+" if groups[place] == "repeat" else r"\d+(?:\.\d+)?"
            text += f"(?P<{groups[place]}>{form})"
        elif len(set(parts)) == 1:
            text += re.escape(parts[0])
        else:
            text += r"\d+(?:\.\d+)?" if NUMBER.fullmatch(parts[0]) else r"[^/]+?"
    return FileNames(text if groups else "", tuple(groups.values()))


def run_names(names: Sequence[str]) -> FileNames:
    """A path with the session and the run of the logs of a robot.

    Folders are sessions. Else the first word of the names is the session, if several files have it.
    """
    ending = r"\.[^/]+"
    if all("/" in name for name in names):
        return FileNames(rf"(?:.*/)?(?P<run>(?P<session>[^/]+)/[^/]+?){ending}", ("session", "run"))
    firsts = [re.split(r"[_\- ]", name.rsplit("/", 1)[-1].partition(".")[0]) for name in names]
    heads = [words[0] for words in firsts]
    counts = {head: heads.count(head) for head in heads}
    if len(counts) > 1 and min(counts.values()) > 1 and all(len(words) > 1 for words in firsts):
        return FileNames(rf"(?:.*/)?(?P<run>(?P<session>[^/_\- ]+)[_\- ][^/]+?){ending}", ("session", "run"))
    return FileNames("", ())
