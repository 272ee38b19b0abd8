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
        If no files are given, they hold no table of numbers, or the draft that was written reads none of them.
    """
    if config["files"] is None:
        raise ValueError("files is not given: swg map my_logs, or swg map files=my_logs")
    draft = draft_map(
        config["files"], config["kind"], {key: value for key, value in config["known"].items() if value is not None}
    )
    out = Path(config["out"])
    draft.save(out)
    print(draft)
    files, map_file = repr(str(draft.path)), repr(str(out))
    gauges = draft.kind == "gauges"
    use = f"read_recordings({files}, {map_file})" if gauges else f"recordings_of({map_file}, {files})"
    print(f"draft: {out}; picture: {out.with_suffix('.png')}; correct it, then use it: swg.{use}")
    if not draft.readable:
        raise ValueError("the draft reads no recording yet: 'read back' above says why; correct it before you use it")


def spelled(words: Sequence[str]) -> list[str]:
    """The words of the command in the spelling of Hydra: words alone name the files.

    >>> spelled(["my logs", "kind=joints"]), spelled(["a.csv", "b.csv"])
    (['files="my logs"', 'kind=joints'], ['files=["a.csv","b.csv"]'])
    """
    # The word after an option of Hydra is the value of this option.
    alone = [
        "=" not in word and "-" not in (word[:1], last[:1]) for last, word in zip(["", *words], words, strict=False)
    ]
    files = ",".join(f'"{word}"' for word, is_file in zip(words, alone, strict=True) if is_file)
    others = [word for word, is_file in zip(words, alone, strict=True) if not is_file]
    return [f"files=[{files}]" if sum(alone) > 1 else f"files={files}", *others] if files else others
