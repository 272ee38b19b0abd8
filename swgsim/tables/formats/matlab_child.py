"""Child process that reads MATLAB files of versions 4 and 5 with SciPy, for :mod:`swgsim.tables.formats.matlab`.

It imports nothing else, so that it starts quickly. Requests come as lines of JSON on standard input. Each answer is a
line of JSON on standard output, followed by the raw numbers of the requested variables.
"""

import json
import sys
import warnings
from pathlib import Path

from scipy.io import loadmat, whosmat

try:
    import resource
    import signal

    LIBRARIES = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
except (ImportError, OSError):  # only Linux has both the limits and the size of the process
    LIBRARIES = 0


def limit(memory: int, seconds: float) -> None:
    """Limit the memory beyond the libraries [byte] and the processor time [s] of the next reading."""
    if LIBRARIES:
        soft, hard = LIBRARIES + memory, resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (soft if hard < 0 else min(soft, hard), hard))
        signal.setitimer(signal.ITIMER_PROF, seconds)


def answer(path: str, names: list[str] | None) -> tuple[dict, list]:
    """List all variables, or read those of the given names."""
    if names is None:
        return {"variables": whosmat(path, appendmat=False)}, []
    content = loadmat(path, variable_names=names, appendmat=False)
    arrays = [content[name] for name in names]
    return {"arrays": [(array.dtype.str, array.shape) for array in arrays]}, arrays


def main() -> None:
    """Answer requests until standard input ends."""
    warnings.simplefilter("ignore")
    for line in sys.stdin:
        request = json.loads(line)
        limit(request["memory"], request["seconds"])
        try:
            header, arrays = answer(request["path"], request["names"])
        except Exception as error:  # SciPy raises errors of many kinds for damaged bytes.
            header, arrays = {"error": f"{type(error).__name__}: {error}"[:500]}, []
        sys.stdout.buffer.write(json.dumps(header).encode() + b"\n")
        for array in arrays:
            if array.dtype.kind in "fiu":
                sys.stdout.buffer.write(array.tobytes())
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
