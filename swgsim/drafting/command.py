"""The command ``swg map``."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from swgsim.drafting.draft import draft_map


def run(config: Mapping[str, Any]) -> None:
    """Draft a map, write it with its picture, and print what was taken for what.

    Raises
    ------
    ValueError
        If no files are given, or they hold no table of numbers.
    """
    if config["files"] is None:
        raise ValueError("files is not given: swg map my_logs, or swg map files=my_logs")
    draft = draft_map(
        config["files"], config["kind"], {key: value for key, value in config["known"].items() if value is not None}
    )
    out = Path(config["out"])
    draft.save(out)
    print(draft)
    files, map_file = repr(str(config["files"])), repr(str(out))
    gauges = draft.kind == "gauges"
    use = f"read_recordings({files}, {map_file})" if gauges else f"recordings_of({map_file}, {files})"
    print(f"draft: {out}; picture: {out.with_suffix('.png')}; correct it, then use it: swg.{use}")


def spelled(words: Sequence[str]) -> list[str]:
    """The words of the command in the spelling of Hydra: a word alone names the files.

    >>> spelled(["my logs", "kind=joints"])
    ['files="my logs"', 'kind=joints']
    """
    return [word if "=" in word or word.startswith("-") else f'files="{word}"' for word in words]
