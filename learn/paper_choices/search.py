"""Trials of the study: draws of all choices from their priors, then an optimiser that sees Tables VII and IX alone.

Trials are kept in a file, so an interrupted study goes on. The optimiser is Optuna's tree-structured Parzen estimator.
"""

import hashlib
import inspect
import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import joblib
import numpy as np
import optuna
from optuna.exceptions import ExperimentalWarning
from optuna.samplers import BaseSampler, PartialFixedSampler, TPESampler
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.study import MaxTrialsCallback
from optuna.trial import FrozenTrial, TrialState
from scipy.stats import qmc

import learn.paper.claims
import learn.paper.feature_claims
import learn.paper_choices.evaluation
import learn.paper_choices.preset
from learn.jobs import identity
from learn.paper.published_tables import Comparison, paper_table
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import FITTED, SAMPLED, SEARCHED, Tables, claims, recordings, tables
from learn.paper_choices.preset import Config, Values
from swgsim.common.version import code_version

# What a trial depends on.
PRIOR = ("usual", "low", "high", "scale")
SOURCES = (learn.paper.claims, learn.paper.feature_claims, learn.paper_choices.evaluation, learn.paper_choices.preset)
DECISIVE = ("grid", "window", "mesh", "gears", "selections", "classifiers", "prior_weight", "seed")
# A trial under whose values the chain or the features fail is pruned; one that was interrupted is done again.
ENDED = (TrialState.COMPLETE, TrialState.PRUNED)


@dataclass(frozen=True)
class Trial:
    """One finished trial.

    Attributes
    ----------
    sampled : bool
        Whether its values were drawn from the priors.
    values : mapping
    objective : float
        As of :func:`objective` [points].
    scores : mapping
        Table to scores in the order of its cells.
    claims : mapping
        C1 to C18 to whether they hold; empty for trials of the optimiser.
    """

    sampled: bool
    values: Values
    objective: float
    scores: Mapping[str, Sequence[float]]
    claims: Mapping[str, bool]

    @property
    def tables(self) -> Tables:
        """The scores beside the paper's."""
        return tables_of(self.scores)


def objective(scored: Tables, choices: Sequence[Choice], values: Values, prior_weight: float) -> float:
    """What the fit minimises [points]: :func:`fitted_error`, and what the values cost by their priors."""
    return fitted_error(scored) + prior_weight * cost(choices, values)


def cost(choices: Sequence[Choice], values: Values) -> float:
    """How much less plausible than the usual values they are, as :meth:`Choice.cost`."""
    return sum(each.cost(values[each.name]) for each in choices if each.fitted)


def fitted_error(scored: Tables) -> float:
    """Mean of the errors of Tables VII and IX [points]."""
    return float(np.mean([scored[table].mean_absolute_difference for table in FITTED]))


def trials(config: Config, choices: Sequence[Choice]) -> list[Trial]:
    """Do the trials that are missing, and return all, as a resolved conf/paper_choices.yaml says."""
    sampled, fitted, workers = config["sampled"], config["fitted"], config["workers"] or joblib.cpu_count()
    study = _study(config)
    for left in study.get_trials(states=(TrialState.RUNNING,)):
        study.tell(left.number, state=TrialState.FAIL)  # of a killed run
    known = [t.user_attrs for t in study.get_trials(states=(*ENDED, TrialState.WAITING))]
    shares = qmc.Sobol(len(choices), rng=config["seed"]).random(sampled)
    for number in sorted(set(range(sampled)) - {each.get("sample") for each in known}):
        place = dict(zip([each.name for each in choices], shares[number].tolist(), strict=True))
        study.enqueue_trial(place, user_attrs={"sample": number})
    for number in sorted(set(range(len(config["starts"]))) - {each.get("start") for each in known}):
        start = config["starts"][number]
        place = {each.name: each.share(start.get(each.name, each.usual)) for each in choices}
        study.enqueue_trial(place, user_attrs={"start": number})
    pool = joblib.Parallel(workers)
    pool(joblib.delayed(_work)(config, choices, number, sampled + fitted) for number in range(workers))
    lost = [each.user_attrs for each in study.get_trials(states=(TrialState.PRUNED,))]
    if lost:
        draws = sum("sample" in each for each in lost)
        print(f"{len(lost)} trials have no result and count nowhere, {draws} of them draws. First: {lost[0]['reason']}")
    return [_trial(each, choices, config["prior_weight"]) for each in study.get_trials(states=(TrialState.COMPLETE,))]


def code() -> str:
    """Digest of the code on which trials depend: the chain, the classifiers, the claims and the presets."""
    parts = [code_version("studies"), identity.code_version(), *(inspect.getsource(each) for each in SOURCES)]
    return hashlib.sha256("".join(parts).encode()).hexdigest()[:12]


def _work(config: Config, choices: Sequence[Choice], worker: int, count: int) -> None:
    """One process: trials until ``count`` have ended."""

    def one(trial: optuna.Trial) -> float:
        values = {each.name: each.value(trial.suggest_float(each.name, 0, 1)) for each in choices}
        sampled = "sample" in trial.user_attrs
        try:
            made = recordings(config, values)
            scored = tables(made, config["classifiers"], SAMPLED if sampled else SEARCHED)
        except ValueError as error:
            trial.set_user_attr("reason", str(error))
            raise optuna.TrialPruned from error
        scores = {name: table.cells["ours"].round(3).tolist() for name, table in scored.items()}
        trial.set_user_attr("scores", scores)
        if sampled:
            trial.set_user_attr("claims", claims(made, scored, values["disturbance"]))
        return objective(scored, choices, values, config["prior_weight"])

    study = _study(config, _sampler(choices, config["seed"] + worker))
    if len(study.get_trials(states=ENDED, deepcopy=False)) < count:
        study.optimize(one, callbacks=[MaxTrialsCallback(count, ENDED)])


def _sampler(choices: Sequence[Choice], seed: int) -> BaseSampler:
    usual = {each.name: each.share(each.usual) for each in choices if not each.fitted}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ExperimentalWarning)
        return PartialFixedSampler(
            usual, TPESampler(multivariate=True, constant_liar=True, n_startup_trials=1, seed=seed)
        )


def _study(config: Config, sampler: BaseSampler | None = None) -> optuna.Study:
    """The study of a configuration; other choices, data, seeds or code make another one, more trials do not."""
    priors = {name: {key: each.get(key) for key in PRIOR} for name, each in config["choices"].items()}
    decisive = [code(), priors, *(config[key] for key in DECISIVE)]
    name = hashlib.sha256(json.dumps(decisive, sort_keys=True).encode()).hexdigest()[:12]
    folder = Path(config["study"])
    folder.mkdir(parents=True, exist_ok=True)
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    storage = JournalStorage(JournalFileBackend(str(folder / f"{name}.journal")))
    return optuna.create_study(storage=storage, sampler=sampler, study_name=name, load_if_exists=True)


def tables_of(scores: Mapping[str, Sequence[float]]) -> dict[str, Comparison]:
    """Tables from their scores."""
    return {name: Comparison(paper_table(name).assign(ours=ours)) for name, ours in scores.items()}


def _trial(found: FrozenTrial, choices: Sequence[Choice], prior_weight: float) -> Trial:
    values = {each.name: each.value(found.params[each.name]) for each in choices}
    scores, holds = found.user_attrs["scores"], found.user_attrs.get("claims", {})
    return Trial(
        "sample" in found.user_attrs, values, objective(tables_of(scores), choices, values, prior_weight), scores, holds
    )
