"""Child process that reads files with libraries that trust them, for :mod:`swgsim.tables.formats.limited`.

It imports the reader of a format when it is asked for it, so that it starts quickly. Requests come as lines of JSON on
standard input. Each answer is a line of JSON on standard output, perhaps followed by the raw numbers of an array.
"""

import json
import sys
import warnings
from contextlib import ExitStack, redirect_stdout
from importlib import import_module
from pathlib import Path

import numpy as np

from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.contents import Contents

try:
    import resource
    import signal

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    LIMITED = Path("/proc/self/statm").exists()
    HARD = resource.getrlimit(resource.RLIMIT_AS)[1]
except ImportError:
    LIMITED = False  # only Linux has both the limits and the size of the process


def limit(memory: int, seconds: float) -> None:
    """Limit the memory beyond the libraries [byte] and the processor time [s] of the next reading."""
    if LIMITED:
        libraries = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        soft = libraries + memory
        resource.setrlimit(resource.RLIMIT_AS, (soft if HARD < 0 else min(soft, HARD), HARD))
        signal.setitimer(signal.ITIMER_PROF, seconds)


def opened(stack: ExitStack, request: dict) -> tuple[dict, Contents | None]:
    """Open a file, in place of the one before."""
    stack.close()
    if LIMITED:
        signal.setitimer(signal.ITIMER_PROF, 0)
        resource.setrlimit(resource.RLIMIT_AS, (HARD, HARD))
    try:
        reader = import_module(f"swgsim.tables.formats.{request['reader']}")
    except ModuleNotFoundError as error:
        return {"absent": error.name}, None
    limit(request["memory"], request["seconds"])
    if "sheets" in request:
        return {"sheets": reader.sheets(Path(request["open"]))}, None
    if "sheet" in request:
        return {"cells": reader.cells(Path(request["open"]), request["file"], request["sheet"])}, None
    contents = stack.enter_context(reader.opened(Path(request["open"]), request["file"], request["wanted"]))
    facts = {"listed": contents.listed, "others": contents.others, "ordered": contents.ordered}
    return {**facts, "timed": contents.time is not None}, contents


def main() -> None:
    """Answer requests until standard input ends."""
    warnings.simplefilter("ignore")
    out, contents = sys.stdout.buffer, None
    with redirect_stdout(sys.stderr), ExitStack() as stack:
        for line in sys.stdin:
            request, numbers = json.loads(line), None
            try:
                if "open" in request:
                    header, contents = opened(stack, request)
                else:
                    assert contents
                    read = contents.time if request["what"] == "time" else contents.read
                    assert read
                    numbers = np.asarray(read(request["place"]))
                    header = {"kind": numbers.dtype.str, "shape": numbers.shape}
            except FileDefect as defect:
                header = {"defect": [defect.file, defect.found, defect.expected, defect.row, defect.column]}
            except Exception as error:  # The libraries raise errors of many kinds for damaged bytes.
                header = {"error": f"{type(error).__name__}: {error}"[:500]}
            out.write(json.dumps(header).encode() + b"\n")
            if numbers is not None and numbers.dtype.kind in "fiu":
                out.write(numbers.tobytes())
            out.flush()


if __name__ == "__main__":
    main()
