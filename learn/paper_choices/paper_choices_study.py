"""The study of ``swg paper-choices``: trials, the best of them judged on all tables, and the report."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import joblib

from learn.paper_choices.analysis import best_of, effects, fit, held, limit, parts_held, reduced, scatter
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import JUDGED, SEARCHED, Tables, claims, recordings, tables
from learn.paper_choices.outcome import Outcome
from learn.paper_choices.page import write
from learn.paper_choices.preset import Values, merged
from learn.paper_choices.search import cost, fitted_error, trials


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
    usual = {each.name: each.usual for each in choices}
    judged = merged(config, config["judged"])
    pool = joblib.Parallel(config["workers"] or joblib.cpu_count())
    memory = joblib.Memory(config["study"], verbose=0)  # an interrupted study goes on after the trials, too
    error, whole = memory.cache(_error), memory.cache(_judged)

    def objectives(tried: Sequence[tuple[Mapping[str, Any], Values, int]]) -> list[float]:
        errors = pool(joblib.delayed(error)(*each) for each in tried)
        return [
            each + config["prior_weight"] * cost(choices, values)
            for each, (_, values, _) in zip(errors, tried, strict=True)
        ]

    def scattered(values: Values) -> tuple[float, float]:
        repeats = [(config, values, seed) for seed in range(1, config["repeats"] + 1)]
        *others, on_all_variants = objectives([*repeats, (judged, values, 0)])
        return scatter(others, on_all_variants)

    every = best_of(trials(config, choices), choices)
    values, tried = reduced(
        every.values,
        choices,
        lambda sets: objectives([(config, each, 0) for each in sets]),
        limit(every, scattered(every.values)),
    )
    fixed = [name for name in usual if values[name] == usual[name]]
    again = {"starts": [*config["starts"], values], "fitted": config["fitted"] + config["fitted_again"]}
    done = trials({**config, **again}, choices, fixed)
    best = best_of([*done, *tried], choices, fixed)
    found = fit(best, [*done, *tried], scattered(best.values))
    before, after, of_all = pool(joblib.delayed(whole)(judged, each) for each in (usual, best.values, every.values))
    outcome = Outcome(
        choices, done, found, before[0], after[0], of_all[0], before[1], after[1], held(done, choices),
        effects(done, choices), parts_held(done),
    )  # fmt: skip
    write(outcome, config, Path(config["out"]))
    return {name: table.mean_absolute_difference for name, table in after[0].items()}


def _error(config: Mapping[str, Any], values: Values, seed: int) -> float:
    """The error that the fit sees, of some values, with a fold and forests of a seed."""
    return fitted_error(tables(recordings(config, values), config["classifiers"], SEARCHED, seed))


def _judged(config: Mapping[str, Any], values: Values) -> tuple[Tables, Mapping[str, bool]]:
    """All cells and claims under some values."""
    made = recordings(config, values)
    scored = tables(made, config["classifiers"], JUDGED)
    return scored, claims(made, scored, values["disturbance"])
