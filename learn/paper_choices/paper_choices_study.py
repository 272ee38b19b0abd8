"""The study of ``swg paper-choices``: trials, the best of them judged on all tables, and the report."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib

from learn.paper_choices.analysis import best_of, effects, fit, held, parts_held
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import JUDGED, SEARCHED, Tables, claims, recordings, tables
from learn.paper_choices.outcome import Outcome
from learn.paper_choices.page import write
from learn.paper_choices.preset import Values, merged
from learn.paper_choices.search import Trial, objective, trials


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Do the study as a resolved ``conf/paper_choices.yaml`` says, and write its report.

    Returns
    -------
    dict
        Mean absolute difference to each table of the paper after the fit [points].

    Raises
    ------
    ValueError
        If a choice has no valid range or prior.
    """
    choices = [Choice(name=name, **options) for name, options in config["choices"].items()]
    done = trials(config, choices)
    best = best_of(done, choices)
    usual = {each.name: each.usual for each in choices}
    judged = merged(config, config["judged"])
    pool = joblib.Parallel(config["workers"] or joblib.cpu_count())
    put_back = [{**best.values, each.name: each.usual} for each in choices if best.values[each.name] != each.usual]
    again = [(config, best.values, seed) for seed in range(1, config["repeats"] + 1)]
    again += [(config, values, 0) for values in put_back] + [(judged, best.values, 0)]
    *objectives, on_all_variants = pool(joblib.delayed(_objective)(choices, *each) for each in again)
    repeats, without = objectives[: config["repeats"]], objectives[config["repeats"] :]
    near = [Trial(False, values, each, {}, {}) for values, each in zip(put_back, without, strict=True)]
    found = fit(best, choices, [*done, *near], repeats, on_all_variants)
    whole = pool(joblib.delayed(_judged)(judged, values) for values in (usual, found.values))
    (before, claims_before), (after, claims_after) = whole
    outcome = Outcome(
        choices, done, found, before, after, claims_before, claims_after, held(done, choices), effects(done, choices),
        parts_held(done),
    )  # fmt: skip
    write(outcome, config, Path(config["out"]))
    return {name: table.mean_absolute_difference for name, table in after.items()}


def _objective(choices: list[Choice], config: Mapping[str, Any], values: Values, seed: int) -> float:
    """The objective of some values, with a fold and forests of a seed."""
    scored = tables(recordings(config, values), config["classifiers"], SEARCHED, seed)
    return objective(scored, choices, values, config["prior_weight"])


def _judged(config: Mapping[str, Any], values: Values) -> tuple[Tables, Mapping[str, bool]]:
    """All cells and claims under some values."""
    made = recordings(config, values)
    scored = tables(made, config["classifiers"], JUDGED)
    return scored, claims(made, scored, values["disturbance"])
