"""The cells of Tables VII to X and the claims under given values of the choices."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from learn.evaluation.evaluate import SplitScore, evaluate
from learn.inputs.features import Selection
from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.paper.claims import table_claims
from learn.paper.feature_claims import SPECTRUM, feature_claims, features_of
from learn.paper.published_tables import PROTOCOLS, Comparison, paper_table
from learn.paper_choices.preset import Config, Values, changes, merged
from learn.protocols.splits import LeaveOneGearOut, RandomFolds, Split
from swgsim.bench.disturbance import Disturbance
from swgsim.dataset.dataset import disturbed
from swgsim.dataset.plan import Plan
from swgsim.dataset.simulate_cases import record
from swgsim.jobs import settings as chain_settings
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.studies.claims import chain_claims
from swgsim.studies.examples import Subject

CONDITIONS = {"table7": "clean", "table8": "disturbed", "table9": "clean", "table10": "disturbed"}
# The fit sees these.
FITTED = ("table7", "table9")
# The perceptron takes half of the time.
COSTLY = "mlp"
# The left-out gear for which it is trained where time is short: its k1 lies between those of the other two.
MIDDLE = "2,3->1"

Tables = Mapping[str, Comparison]


@dataclass(frozen=True)
class Effort:
    """How many cells are computed.

    Attributes
    ----------
    tables : tuple of str
    every_gear : bool
        Whether the perceptron is trained for each gear left out, or for gear 1 alone.
    """

    tables: tuple[str, ...]
    every_gear: bool


SEARCHED = Effort(FITTED, every_gear=False)
SAMPLED = Effort(tuple(PROTOCOLS), every_gear=False)
JUDGED = Effort(tuple(PROTOCOLS), every_gear=True)


@dataclass(frozen=True)
class Recordings:
    """The clean and the disturbed recordings of one set of values, and the selections with their options."""

    plan: Plan
    blocks: Mapping[str, Sequence[LabelledSignals]]
    selections: Mapping[str, Selection]


def recordings(config: Config, values: Values) -> Recordings:
    """Simulate the data sets under some values, as a resolved conf/paper_choices.yaml says.

    Raises
    ------
    ValueError
        If the chain has no steady motion under the values, or the features cannot be computed.
    """
    changed = changes(values, config)
    parts = {key: config[key] for key in ("grid", "window", "mesh", "condition", "gears")}
    plan = chain_settings.plan(merged(parts, {key: changed[key] for key in changed.keys() & parts.keys()}))
    disturbance = Disturbance(values["disturbance"], values["disturbance"])
    clean = [record(plan, cases) for cases in plan.blocks()]
    options = {name: merged(each, changed["features"]) for name, each in config["selections"].items()}
    return Recordings(
        plan,
        {"clean": clean, "disturbed": [disturbed(block, disturbance) for block in clean]},
        {name: Selection(**each) for name, each in options.items()},
    )


@threadpool_limits.wrap(limits=1)
def tables(made: Recordings, classifiers: Mapping[str, Config], effort: Effort, seed: int = 0) -> dict[str, Comparison]:
    """Our scores beside the paper's cells.

    Same gears are judged on one fold of four; for cells that the perceptron is not trained for, those of another gear
    left out stand.

    Parameters
    ----------
    made : Recordings
    classifiers : mapping
        Name to configuration, those of Table VI.
    effort : Effort
    seed : int
        Of the fold and of the classifiers that draw at random.
    """
    data = {
        (condition, name): selection.learning_set(made.blocks[condition])
        for condition in {CONDITIONS[table] for table in effort.tables}
        for name, selection in made.selections.items()
    }
    result = {}
    for table in effort.tables:
        cells = paper_table(table)
        ours = pd.Series(np.nan, cells.index)
        for (features, name), group in cells.groupby(["features", "classifier"]):
            options = dict(classifiers[str(name)])
            options |= {"seed": seed} if "seed" in options else {}
            scores = _scores(data[CONDITIONS[table], str(features)], table, options, effort, seed)
            ours.loc[group.index] = np.array([_score(scores, row) for row in group["row"]])
        result[table] = Comparison(cells.assign(ours=ours))
    return result


def claims(made: Recordings, scored: Tables, disturbance: float) -> dict[str, bool]:
    """Whether each of C1 to C18 holds.

    Parameters
    ----------
    made : Recordings
    scored : mapping
        All four tables.
    disturbance : float
        Largest amplitude of eq. (10) [mV/V].
    """
    spectrum = made.selections["selection_3"]
    options = {name: getattr(spectrum, name) for name in ("orders", "floor", "whole_revolutions")}
    features = features_of(made.blocks["clean"], Selection(**(vars(SPECTRUM) | options)))
    of_chain = chain_claims(Subject.of(made.plan))
    findings = [*of_chain, *feature_claims(features), *table_claims(scored, features, disturbance)]
    return {finding.key: finding.holds for finding in findings}


def _scores(data: LearningSet, table: str, classifier: Config, effort: Effort, seed: int) -> dict[str, SplitScore]:
    """The score of each split by its name; that of a fold is called ``fold 1``."""
    few = classifier["name"] == COSTLY and not effort.every_gear
    labels = data.table["label"].astype(str).to_numpy()
    splits: list[Split] = []
    if PROTOCOLS[table] == "random_folds":
        splits = [next(RandomFolds(seed=seed).split(data.features, data.table))]
    else:
        splits = [s for s in LeaveOneGearOut().split(data.features, data.table) if not few or s.name == MIDDLE]
    found = evaluate(data.features, labels, splits, settings.classifier(classifier))
    return {score.name: score for score in found.scores}


def _score(scores: Mapping[str, SplitScore], row: str) -> float:
    if row in ("train", "test"):
        return float(getattr(scores["fold 1"], row))
    # The perceptron that was trained for one gear alone stands for all.
    return (scores[MIDDLE] if set(scores) == {MIDDLE} else scores[row]).test
