"""The help of one command: its choices with the comments of its file in ``conf/``."""

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile

from swgsim.common.configured import conf_folder

# A line of a block "defaults:", such as "  - gear@gears.gear1: gear1 # comment".
GROUP = re.compile(r"\s*- (?P<group>(?!override)[\w/]+)(?P<where>@[\w.]+)?: (?P<option>\w+)")
# A key with its value, or with a block of keys below it.
KEY = re.compile(r"(?P<indent> *)(?P<key>\w+):\s*(?P<value>.*)")
ENDING = (
    """'swg {name} --cfg job' prints all values. -m runs every combination of values that are separated by commas."""
)


def usage(name: str, file: str) -> str:
    """What a command does, the groups of files to choose from, and its values with their defaults.

    Parameters
    ----------
    name : str
        Of the command.
    file : str
        Its file in ``conf/``, without the ending.

    Examples
    --------
    >>> print(usage("effects", "effects").splitlines()[0])
    List the library of physical effects.
    """
    lines = (conf_folder() / f"{file}.yaml").read_text(encoding="utf-8").splitlines()
    head = [line.removeprefix("#").strip() for line in takewhile(lambda line: line.startswith("#"), lines)]
    blocks = _blocks(lines[len(head) :])
    groups = list(_groups(blocks.pop("defaults", [])))
    blocks.pop("hydra", None)
    values = [row for block in blocks.values() for row in _values(block)]
    shown = [*head, *_section("choices, each a file of conf/NAME/", groups), *_section("values", values)]
    return "\n".join([*shown, "", ENDING.format(name=name)])


def _blocks(lines: Sequence[str]) -> dict[str, list[str]]:
    """The lines of every key of the file, with the comments above it."""
    blocks: dict[str, list[str]] = {}
    above: list[str] = []
    key = ""
    for line in lines:
        if found := re.match(r"(\w+):", line):
            key = found[1]
            blocks[key], above = [*above, line], []
        elif line.startswith("#"):
            above.append(line)
        elif key and line.strip():
            blocks[key].append(line)
    return blocks


def _groups(lines: Sequence[str]) -> Iterator[tuple[str, str]]:
    for line in lines:
        if found := GROUP.match(line):
            yield f"{found['group']}{found['where'] or ''}={found['option']}", _comment(line)
            yield (
                "",
                "one of " + ", ".join(sorted(path.stem for path in (conf_folder() / found["group"]).glob("*.yaml"))),
            )
        elif (other := line.strip(" -")).isidentifier() and other != "_self_":
            yield f"and the choices of 'swg {other} --help'", ""


def _values(lines: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Values with the keys that lead to them; what is deeper than keys with values is left to the file."""
    path: dict[int, str] = {}
    unclosed = 0  # braces of a value of several lines, of which the first one is shown
    for line in lines:
        inside, plain = unclosed > 0, line.split(" #")[0].rstrip()
        unclosed += plain.count("{") - plain.count("}")
        if line.startswith("#"):
            yield line.removeprefix("#").strip(), ""
        elif not inside and (found := KEY.fullmatch(plain)):
            depth = len(found["indent"])
            path = {each: key for each, key in path.items() if each < depth} | {depth: found["key"]}
            if found["value"] or _comment(line):
                value = f"={found['value']}{' …}' * (unclosed > 0)}" if found["value"] else ":"
                yield ".".join(path.values()) + value, _comment(line)


def _comment(line: str) -> str:
    return line.partition(" #")[2].strip()


def _section(title: str, rows: Sequence[tuple[str, str]]) -> Iterator[str]:
    if rows:
        yield from ("", f"{title}:")
        width = max((len(choice) for choice, comment in rows if comment), default=0)
        yield from (f"  {choice:{width}}  {comment}".rstrip() for choice, comment in rows)
