"""Ask virtual robot joints: python tests/robots [OUT] [--count N] [--foreign N] [--kind NAME ...] (make robots).

The last day of every joint judges. An answer is kept in OUT as a file, so that an interrupted run continues. The counts
go to report/robots.json: how many joints got an effect, which, and with which verdict.
"""

import argparse
import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from joblib import Parallel, delayed
from scipy.stats import binomtest
from threadpoolctl import threadpool_limits

sys.path.insert(0, str(Path(__file__).parent.parent))  # run by its path, a folder knows only its own files

import swgsim as swg
from robots import KINDS, joint
from swgsim.common.files import write_json
from swgsim.common.version import code_version


def main() -> None:
    """Ask, count, print and write."""
    parser = argparse.ArgumentParser(prog="robots", description=__doc__.partition("\n")[0])
    parser.add_argument("out", type=Path, nargs="?", default=Path("robots"))
    parser.add_argument("--count", type=int, default=500, help="healthy joints")
    parser.add_argument("--foreign", type=int, default=50, help="joints of each other kind")
    parser.add_argument("--kind", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--report", type=Path, default=Path("report"))
    parser.add_argument("--jobs", type=int, default=-1)
    chosen = parser.parse_args()
    number = {kind: chosen.count if kind == "healthy" else chosen.foreign for kind in chosen.kind}
    jobs = [(kind, seed) for kind in chosen.kind for seed in range(number[kind])]
    answers = Parallel(n_jobs=chosen.jobs, verbose=5)(delayed(kept)(chosen.out, *job) for job in jobs)
    scores = [score(kind, [each for each in answers if each["kind"] == kind]) for kind in chosen.kind]
    write_json(chosen.report / "robots.json", scores)
    for each in scores:
        print(json.dumps(each, indent=1))


def kept(out: Path, kind: str, seed: int) -> dict[str, Any]:
    """The answer to one joint; that of the same code is reused."""
    path, code = out / kind / f"{seed:03d}.json", code_version("joint")
    if path.exists() and (known := json.loads(path.read_text()))["code"] == code:
        return known
    with threadpool_limits(1):
        found = {"kind": kind, "seed": seed, "code": code, **asked(seed, kind)}
    write_json(path, found)
    return found


def asked(seed: int, kind: str) -> dict[str, Any]:
    """The truth of a joint, and the answer to its recordings."""
    moving, at_rest, truth = joint(seed, kind)
    recordings = swg.JointRecordings(moving, at_rest, ())
    last = max(each.session for each in moving)
    lengths = [float(each.time[-1]) for each in moving]
    true = asdict(truth) | {name: getattr(truth, name)._asdict() for name in ("plant", "drive", "limits")}
    known = {"truth": true, "recordings": len(moving), "seconds_recorded": sum(lengths)}
    began = process_time()
    try:
        report = swg.identify(recordings, signal=truth.signal, holdout=last).report
    except (ValueError, RuntimeError, ArithmeticError) as error:
        return {**known, "refused": f"{type(error).__name__}: {error}", "seconds": process_time() - began}
    fields = ("verdict", "sentence", "lacks", "effects", "error", "noise_floor", "unknown")
    return {**known, "refused": None, "seconds": process_time() - began} | {name: report[name] for name in fields}


def score(kind: str, answers: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of the answers of a kind, with binomial intervals."""
    given = [each for each in answers if not each["refused"]]
    names = Counter(name for each in given for name in {effect["name"] for effect in each["effects"]})
    verdicts = Counter(each["verdict"] for each in given)
    seconds = [each["seconds"] for each in given]
    return {
        "kind": kind,
        "joints": len(answers),
        "refused": len(answers) - len(given),
        "any_effect": share(sum(bool(each["effects"]) for each in given), len(given)),
        "effects": {name: share(number, len(given)) for name, number in names.most_common()},
        "verdicts": {name: share(number, len(given)) for name, number in verdicts.most_common()},
        "seconds_median": float(np.median(seconds)) if seconds else None,
        "seconds_worst": max(seconds, default=None),
    }


def share(number: int, of: int) -> dict[str, Any] | None:
    """A share with the exact interval of C. Clopper and E. Pearson, Biometrika 26, 1934."""
    if of == 0:
        return None
    low, high = binomtest(number, of).proportion_ci(0.95)
    return {"number": number, "of": of, "share": number / of, "ci95": [float(low), float(high)]}


if __name__ == "__main__":
    main()
