"""The search: it goes on after an interruption, sees two tables alone, and finds what explains them."""

import numpy as np
import pytest

from learn.paper.published_tables import PROTOCOLS, Comparison, paper_table
from learn.paper_choices import search
from learn.paper_choices.choice import Choice

CHOICES = [
    Choice(name, usual=1.0, low=0.1, high=10.0, unit="-", meaning=name, source="", fitted=name != "disturbance")
    for name in ("cause", "disturbance")
]
TRUE = 4.0  # value of the cause under which all scores are the paper's
KEYS = ("grid", "window", "mesh", "gears", "selections", "classifiers")


def missed(points, names):
    """Scores that differ from the paper's by some points."""
    return {name: Comparison(paper_table(name).assign(ours=lambda cells: cells["paper"] + points)) for name in names}


@pytest.fixture
def made(monkeypatch):
    """Scores that miss the paper's by 10 points for a factor of ten of the cause; returns the values of the trials."""
    done = []

    def recordings(config, values):
        if len(done) == config.get("killed_after"):
            raise KeyboardInterrupt
        if values["cause"] > config.get("steady_below", np.inf):
            raise ValueError("no steady motion")
        done.append(values)
        return values

    def tables(values, classifiers, effort):
        return missed(10 * abs(np.log10(values["cause"] / TRUE)), effort.tables)

    monkeypatch.setattr(search, "recordings", recordings)
    monkeypatch.setattr(search, "tables", tables)
    monkeypatch.setattr(search, "claims", lambda made, scored, disturbance: {"C1": True})
    return done


def config(folder, **changed):
    priors = {name: {"usual": 1.0, "low": 0.1, "high": 10.0} for name in ("cause", "disturbance")}
    options = {
        "sampled": 4,
        "fitted": 6,
        "workers": 1,
        "seed": 3,
        "prior_weight": 0.1,
        "starts": [],
        "study": str(folder),
    }
    return {"choices": priors, **{key: {} for key in KEYS}, **options, **changed}


def test_the_optimiser_comes_nearer_to_the_cause_and_leaves_alone_what_it_cannot_see(made, tmp_path):
    found = search.trials(config(tmp_path, fitted=30), CHOICES)
    drawn, tried = ([t for t in found if t.sampled is kind] for kind in (True, False))
    assert (len(drawn), len(tried)) == (4, 30)
    best = min(tried, key=lambda trial: trial.objective)
    assert best.objective < min(trial.objective for trial in drawn)
    assert best.values["cause"] == pytest.approx(TRUE, rel=0.3)
    assert [trial.values["disturbance"] for trial in tried] == pytest.approx([1.0] * 30)


def test_only_draws_are_judged_on_all_tables(made, tmp_path):
    found = search.trials(config(tmp_path, fitted=1), CHOICES)
    assert [set(trial.scores) for trial in found] == [set(PROTOCOLS)] * 4 + [{"table7", "table9"}]
    assert [bool(trial.claims) for trial in found] == [True] * 4 + [False]


def test_an_interrupted_study_goes_on(made, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        search.trials(config(tmp_path, killed_after=1), CHOICES)
    whole = search.trials(config(tmp_path), CHOICES)
    assert len(made) == len(whole) == 10
    again = search.trials(config(tmp_path), CHOICES)
    assert len(made) == 10
    assert [trial.values for trial in again] == [trial.values for trial in whole]


def test_draws_without_a_result_are_counted_aloud(made, tmp_path, capsys):
    found = search.trials(config(tmp_path, sampled=8, fitted=0, steady_below=1.0), CHOICES)
    assert len(found) == 4
    lost = "4 trials have no result and count nowhere, 4 of them draws. First: no steady motion"
    assert lost in capsys.readouterr().out


def test_other_code_makes_another_study(made, tmp_path, monkeypatch):
    search.trials(config(tmp_path), CHOICES)
    monkeypatch.setattr(search, "code", lambda: "another chain")
    search.trials(config(tmp_path), CHOICES)
    assert len(made) == 20


def test_an_unusual_value_must_gain_what_its_prior_costs():
    scored = missed(2, ("table7", "table9"))
    usual, far = {"cause": 1.0, "disturbance": 1.0}, {"cause": 10.0, "disturbance": 10.0}
    assert search.objective(scored, CHOICES, usual, prior_weight=0.1) == pytest.approx(2)
    assert search.objective(scored, CHOICES, far, prior_weight=0.1) == pytest.approx(2.2)
