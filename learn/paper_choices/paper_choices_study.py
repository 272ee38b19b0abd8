"""The study of ``swg paper-choices``: trials, the best of them judged on all tables, and the report."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import joblib
import numpy as np
from jaxtyping import Float

from learn.paper_choices.analysis import best_of, effects, fit, held, parts_held, reduced
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import JUDGED, SEARCHED, Tables, claims, recordings, tables
from learn.paper_choices.outcome import Outcome
from learn.paper_choices.page import write
from learn.paper_choices.preset import Values, merged
from learn.paper_choices.search import code, cost, fitted_error, trials


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
    memory = joblib.Memory(Path(config["study"]) / code(), verbose=0)  # an interrupted study goes on after the trials
    error, whole = memory.cache(_error), memory.cache(_judged)

    def objectives(sets: Sequence[Values], seeds: Sequence[int] = (0,)) -> list[float]:
        each = [(values, seed) for values in sets for seed in seeds]
        errors = pool(joblib.delayed(error)(config, *one) for one in each)
        costs = [config["prior_weight"] * cost(choices, values) for values, _ in each]
        return np.add(errors, costs).tolist()

    def repeated(values: Values) -> Float[np.ndarray, " seed"]:
        return np.array(objectives([values], range(1, config["repeats"] + 1)))

    done = trials(config, choices)
    best = best_of(done, choices)
    values, deviation = reduced(best.values, choices, objectives, repeated)
    found = fit(best, values, done, deviation, choices)
    before, after, of_all = pool(joblib.delayed(whole)(judged, each) for each in (usual, values, best.values))
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
