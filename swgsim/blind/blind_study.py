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
from swgsim.blind import judged
from swgsim.blind.attempt import attempt
from swgsim.blind.bench import Setting
from swgsim.blind.drawing import draw
from swgsim.blind.judged import Judged
from swgsim.blind.score import account, score
from swgsim.blind.sealed import SHORT, as_json, from_json
from swgsim.blind.strata import DETECTABLE, plans
from swgsim.blind.table import table
from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker, write_json, write_text
from swgsim.common.version import code_version
from swgsim.effects.library import SEARCHED, listed, named
from swgsim.gear.acquisition import Window
from swgsim.identification.commissioning import commissioning, lack_of_fit, relinearisation
from swgsim.identification.data import measured
from swgsim.identification.decide import (
    accepted,
    candidate,
    competing_regularities,
    empirical_terms,
    form_error_evidence,
    pairs,
    selection_step,
    stepwise_selection,
)
from swgsim.identification.fit import fitted, fitting, form_error, priors, unit
from swgsim.identification.interharmonics import named_interharmonics
from swgsim.identification.report import answer
from swgsim.identification.search import detection_limit, high_orders, regularities, screening, shortlist
from swgsim.jobs import settings

THRESHOLDS = {
    "alpha": shortlist.ALPHA,
    "least_gain": form_error.LEAST_GAIN,
    "likelier": candidate.LIKELIER,
    "least_evidence": candidate.LEAST_EVIDENCE,
    "exact": candidate.EXACT,
    "own": candidate.OWN,
    "pair_gain": pairs.PAIR_GAIN,
    "most": [stepwise_selection.MOST_STEPS, stepwise_selection.MOST_AGAIN, regularities.MOST_ATOMS],
    "leaders": [shortlist.LEADERS, shortlist.NEARLY_LEADERS],
    "nearly": shortlist.NEARLY,
    "form_tolerance": form_error.FORM_TOLERANCE,
    "absorbed": form_error_evidence.ABSORBED,
    "contradiction": form_error.CONTRADICTION,
    "no_size": form_error.NO_SIZE,
    "cancelled": accepted.OPPOSED,
    "left": accepted.LEFT,
    "of_session": measured.OF_SESSION,
    "wandering": [measured.WANDER, measured.KEPT, measured.MOST_WANDER],
    "visible": [screening.VISIBLE, detection_limit.MOSTLY_ABSORBED],
    "set_apart": selection_step.SET_APART,
    "wide": regularities.WIDE,
    "above": [high_orders.KNOWN, answer.MOST_ABOVE],
    "structure": [unit.STRUCTURE, unit.OF_MESH, priors.COURSE, priors.S0_ARMS],
    "unexplained": lack_of_fit.UNEXPLAINED,
    "bent": [fitting.BENT, fitting.MISFIT],
    "turns": [fitting.TURNS, fitting.UNREPEATED, fitting.SAME_SCATTER],
    "balanced": [fitted.LIKELIER_BALANCED, *fitted.BALANCED],
    "luck": lack_of_fit.FALSE_DISCOVERIES,
    "relined": [relinearisation.ROUNDS, relinearisation.AT_REST],
    "drives": [commissioning.DRIVES, commissioning.TIMES, priors.MOST],
    "friction": [priors.SERIES, priors.ANY_FRICTION],
    "unheard": unit.UNHEARD,
    "loosest": [commissioning.MOST_LEARNED, commissioning.FOREIGN_SHARE],
    "tolerance_of_lines": named_interharmonics.TOLERANCE,
    "contradiction_of_lines": named_interharmonics.CONTRADICTION,
    "outdone": [
        form_error.OUTDONE,
        form_error.OUTDONE_SHARE,
        competing_regularities.SAME_THING,
        competing_regularities.DWARFED,
    ],
    "another_thing": competing_regularities.ANOTHER_THING,
    "elsewhere": competing_regularities.ELSEWHERE,
    "patches": [empirical_terms.WORSE, empirical_terms.WORSE_TOGETHER, empirical_terms.KEPT],
    "detectable": DETECTABLE,
    "short": SHORT,
    "look_alike": judged.LOOK_ALIKE,
    "worse": judged.WORSE,
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
        cases = [Judged(from_json(plain), answer_) for plain, answer_ in zip(_opened(folder), answers, strict=True)]
    found = {
        "truth_sha256": digest,
        "code": key["code"],
        "thresholds": THRESHOLDS,
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


def _draw_figure(report: Path, cases: Sequence[Judged], found: Mapping[str, Any]) -> None:
    from swgsim.blind.figure import picture

    with replacing(report / "blind.png") as aside:
        aside.write_bytes(picture(cases, found))
