"""The command ``swg blind``: seal a set of cases, identify every case, open the truth, score."""

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from swgsim.bench.scatter import Bench
from swgsim.blind import scored_case
from swgsim.blind.attempt import attempt
from swgsim.blind.bench import Setting
from swgsim.blind.drawing import draw
from swgsim.blind.score import account, score
from swgsim.blind.scored_case import ScoredCase
from swgsim.blind.sealed import as_json, from_json
from swgsim.blind.strata import DETECTABLE, plans
from swgsim.blind.table import table
from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker, write_json, write_text
from swgsim.common.version import code_version
from swgsim.effects.library import SEARCHED, listed, named
from swgsim.gear.acquisition import Window
from swgsim.identification.decide import prior
from swgsim.jobs import settings

# The numbers that the decision has: its priors. All others are declared errors or numerical.
PRIORS = {
    "healthy": prior.HEALTHY,
    "unknown": prior.OUTSIDE_LIBRARY,
    "another": prior.ANOTHER,
    "balanced": [prior.BALANCED, *prior.TIMES_BALANCED],
    "resembling": prior.RESEMBLING,
    "form_errors": prior.FORM_ERRORS,
    "other_forms": prior.OTHER_FORMS,
    "scales": prior.LOG_SIZE_RANGE,
    "detectable": DETECTABLE,
    "look_alike": scored_case.LOOK_ALIKE,
    "worse": scored_case.WORSE,
}


def run(config: Mapping[str, Any]) -> dict[str, Any]:
    """Write ``<report>/blind.json`` and ``blind.png``; the set and the answers stay in ``<blind>``.

    Returns
    -------
    dict
        What blind.json holds.

    Raises
    ------
    ValueError
        If the folder holds a set of other settings, or one that was changed after it was sealed.
    """
    folder, report = Path(config["blind"]), Path(config["report"])
    with sole_maker(folder / "truth.json"):
        setting = setting_of(config)
        digest = _seal(folder, setting, config)
        key = {"truth": digest, "code": _code()}
        answers = _answer(folder, setting, key, Engine.of(config))
        cases = [ScoredCase(from_json(plain), answer_) for plain, answer_ in zip(_opened(folder), answers, strict=True)]
    found = {
        "truth_sha256": digest,
        "code": key["code"],
        "priors": PRIORS,
        **score(cases),
        "all": [account(case) for case in cases],
    }
    write_json(report / "blind.json", found)
    _draw_figure(report, cases, found)
    print(table(found))
    return found


def setting_of(config: Mapping[str, Any]) -> Setting:
    """The settings that all cases share."""
    chosen = config["library"]
    return Setting(
        settings.gear(config["gear"]),
        settings.build(Bench, config["condition"]["bench"]),
        settings.build(Window, config["window"]),
        tuple(map(named, listed(chosen))) if chosen else SEARCHED,
        config["revolutions"],
        tuple(config["sectors"]),
        config["seed"],
    )


def _seal(folder: Path, setting: Setting, config: Mapping[str, Any]) -> str:
    """Draw the set, unless it is there, and return the digest that it was sealed with."""
    truth, seal = folder / "truth.json", folder / "truth.sha256"
    library = [kind.name() for kind in setting.library]
    chosen = {name: config[name] for name in ("cases", "seed", "sectors", "revolutions", "gear", "condition", "window")}
    made_from = json.loads(json.dumps({**chosen, "library": library}))
    if not seal.exists():
        planned = plans(config["cases"], setting.seed, setting.library)
        jobs = {folder / "drawn" / f"{plan.number:04d}.json": (plan, setting) for plan in planned}
        drawn = _all(jobs, _draw, made_from, Engine.of(config), "sealed set")
        write_json(truth, {"made_from": made_from, "drawn_by": _code(), "cases": drawn})
        write_text(seal, _digest(truth) + "\n")
    if _digest(truth) != seal.read_text().strip():
        raise ValueError(f"{truth} is not what {seal} was written for: the truth was changed after it was sealed")
    if json.loads(truth.read_text())["made_from"] != made_from:
        raise ValueError(f"{truth} is a set of other settings: choose another folder with blind=...")
    return _digest(truth)


def _answer(folder: Path, setting: Setting, key: Mapping[str, str], engine: Engine) -> list[dict[str, Any]]:
    """The answers to all cases; answers that the same code has given before are reused."""
    jobs = {folder / "answers" / f"{plain['number']:04d}.json": (plain, setting) for plain in _opened(folder)}
    return _all(jobs, _attempted, key, engine, "answers")


def _opened(folder: Path) -> list[dict[str, Any]]:
    """The truth of all cases: for the bench that records them, and for the scorer."""
    return json.loads((folder / "truth.json").read_text())["cases"]


def _draw(plan: Any, setting: Setting) -> dict[str, Any]:
    return as_json(draw(plan, setting))


def _attempted(plain: Mapping[str, Any], setting: Setting) -> dict[str, Any]:
    """One case; an error counts as a failure."""
    try:
        return attempt(from_json(plain), setting)
    except (ValueError, np.linalg.LinAlgError, ArithmeticError, RuntimeError) as failure:
        return {"failure": f"{type(failure).__name__}: {failure}"}


def _all(
    jobs: Mapping[Path, tuple], work: Callable[..., dict], key: Mapping[str, Any], engine: Engine, what: str
) -> list[dict[str, Any]]:
    """Results of all jobs; each becomes a file at once, so that an interrupted run can continue."""
    kept = {path: _kept(path, key) for path in jobs}
    left = [path for path, found in kept.items() if found is None]
    tasks = ((path, work, jobs[path], key) for path in left)
    with tqdm(total=len(jobs), initial=len(jobs) - len(left), desc=what, unit=" cases") as bar:
        for path, found in zip(left, engine.results(_one, tasks, len(left)), strict=True):
            kept[path] = found
            bar.update()
    return [found for found in kept.values() if found is not None]


def _one(path: Path, work: Callable[..., dict], job: Sequence[Any], key: Mapping[str, Any]) -> dict[str, Any] | None:
    """Do a job and keep its result, which is given as it will be read."""
    with threadpool_limits(1), sole_maker(path, wait=True):  # a worker of a killed run may be at this very case
        write_json(path, {"key": dict(key), "found": work(*job)})
    return _kept(path, key)


def _kept(path: Path, key: Mapping[str, Any]) -> dict[str, Any] | None:
    """The result of a file, if it is there and made from the same."""
    if not path.exists():
        return None
    held = json.loads(path.read_text())
    return held["found"] if held["key"] == key else None


def _code() -> str:
    """Version of the chain, with the loop, this test and its bench."""
    return code_version("blind", "identification")


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _draw_figure(report: Path, cases: Sequence[ScoredCase], found: Mapping[str, Any]) -> None:
    from swgsim.blind.figure import picture

    with replacing(report / "blind.png") as aside:
        aside.write_bytes(picture(cases, found))
