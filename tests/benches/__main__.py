"""Ask every bench of another author: python tests/benches [OUT] [--only NAME ...] [--cases K ...] [--seed S].

Each gear is recorded healthy, commissioned, recorded again, and examined with the whole library. An answer is kept in
OUT as a file, so that an interrupted run continues. The scores go to report/other_benches.json. With --diagnose, the
twin is asked instead, on healthy gears and those with one of its faults; its scores go to report/other_authors.json.
"""

import argparse
import json
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from diagnoses import code, diagnosed, errors
from gears import BENCHES, GEARS, recorded
from joblib import Parallel, delayed
from threadpoolctl import threadpool_limits

import swgsim as swg
from swgsim.common.files import write_json
from swgsim.common.version import code_version
from swgsim.effects.base import BY_STRUCTURE
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import quantities, size_of


def main() -> None:
    """Ask, score, print and write."""
    parser = argparse.ArgumentParser(prog="benches", description=__doc__.partition("\n")[0])
    parser.add_argument("out", type=Path, nargs="?", default=Path("benches"))
    parser.add_argument("--only", nargs="+", choices=BENCHES, default=list(BENCHES))
    parser.add_argument("--cases", nargs="+", type=int, default=range(GEARS))
    parser.add_argument("--seed", type=int, default=1, help="other gears with the same effects")
    parser.add_argument("--report", type=Path, default=Path("report"))
    parser.add_argument("--jobs", type=int, default=-1)
    parser.add_argument("--diagnose", action="store_true", help="ask the twin")
    chosen = parser.parse_args()
    jobs = list(product(chosen.only, chosen.cases))
    out, ask, made = chosen.out, asked, code_version("identification")
    if chosen.diagnose:
        out, ask, made = chosen.out / "diagnoses", diagnosed, code()
    answers = Parallel(n_jobs=chosen.jobs, verbose=5)(delayed(kept)(ask, made, out, *job, chosen.seed) for job in jobs)
    if chosen.diagnose:
        write_json(chosen.report / "other_authors.json", found := errors(answers))
        print(found)
        return
    scores = [score(name, [a for (of, _), a in zip(jobs, answers, strict=True) if of == name]) for name in chosen.only]
    write_json(chosen.report / "other_benches.json", scores)
    for each in scores:
        print(each)


def kept(
    ask: Callable[[Path], dict[str, Any]], made: str, out: Path, name: str, case: int, seed: int
) -> dict[str, Any]:
    """The answer to one gear; that of the same code is reused."""
    path = out / name / f"{seed}-{case:02d}.json"
    if path.exists() and (known := json.loads(path.read_text()))["code"] == made:
        return known
    with tempfile.TemporaryDirectory() as folder, threadpool_limits(1):
        recorded(Path(folder), name, case, seed)
        found = {"bench": name, "case": case, "seed": seed, "code": made, **ask(Path(folder))}
    write_json(path, found)
    return found


def asked(folder: Path) -> dict[str, Any]:
    """The truth of a gear, and the answer to its recordings."""
    truth = json.loads((folder / "truth.json").read_text())
    began = process_time()
    try:
        unit = swg.commission(swg.read_recordings(folder / "healthy"), swg.Gear())
        ready = process_time()
        report = swg.identify(swg.read_recordings(folder / "again"), unit).report
    except (ValueError, RuntimeError, ArithmeticError) as error:
        return {"truth": truth, "refused": f"{type(error).__name__}: {error}"}
    fields = ("verdict", "sentence", "probability", "effects", "alternatives", "options", "small", "structure")
    seconds = {"commissioning": ready - began, "answer": process_time() - ready}
    return {"truth": truth, "refused": None, "seconds": seconds, **{name: report[name] for name in fields}}


def score(name: str, answers: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of right answers of a bench; None where nothing counts."""
    given = [each for each in answers if not each["refused"]]
    healthy = [each for each in given if each["truth"]["effect"] is None]
    known = [each for each in given if each["truth"]["effect"] and each["truth"]["library"]]
    unknown = [each for each in given if each["truth"]["effect"] and not each["truth"]["library"]]
    right = [each for each in known if each["truth"]["effect"] in _names(each)]
    seconds = [each["seconds"]["answer"] for each in given]
    commissioning = [each["seconds"]["commissioning"] for each in given]
    return {
        "name": name,
        "gears": len(answers),
        "asked_once": BENCHES[name].asked_once,
        "right_first": _share(each["truth"]["effect"] in _names(each)[:1] for each in known),
        "right_in_set": _share(_in_set(each) for each in known),
        "healthy_right": _share(each["verdict"] == "nothing_missing" for each in healthy),
        "unknown_right": _share(each["verdict"] == "unknown_effect" for each in unknown),
        "false_beside": _share(len(_names(each)) > 1 for each in right),
        "coverage95": _share(covered for each in right if (covered := _covered(each)) is not None),
        "seconds_median": float(np.median(seconds)) if seconds else None,
        "seconds_worst": max(seconds, default=None),
        "commissioning_median": float(np.median(commissioning)) if commissioning else None,
        "commissioning_worst": max(commissioning, default=None),
        "refused": len(answers) - len(given),
    }


def _names(answer: Mapping[str, Any]) -> list[str]:
    return [effect["name"] for effect in answer["effects"]]


def _in_set(answer: Mapping[str, Any]) -> bool:
    named = {effect["name"] for other in answer["alternatives"] for effect in other["effects"]}
    return answer["truth"]["effect"] in {*named, *_names(answer)}


def _covered(answer: Mapping[str, Any]) -> bool | None:
    """Whether the interval of an effect on the structure contains the size; None for other effects, and for shares, of
    which every author has his own definition.
    """
    name, size = answer["truth"]["effect"], answer["truth"]["size"]
    kind = LIBRARY[name]
    unit = quantities(kind)[size_of(kind)].unit
    if kind.place not in BY_STRUCTURE or unit not in ("m", "rad"):
        return None
    (found,) = [effect["parameters"][size_of(kind)] for effect in answer["effects"] if effect["name"] == name][:1]
    return found["ci95"] is not None and bool(found["ci95"][0] <= size <= found["ci95"][1])


def _share(right: Iterable[bool]) -> float | None:
    values = list(right)
    return float(np.mean(values)) if values else None


if __name__ == "__main__":
    main()
