"""The report of the study: its fields, its answer, and its page."""

import json
import re
from dataclasses import replace

import pandas as pd
import pytest
from paper_choices.study_configuration import CHOICES, CONFIG, USUAL

from learn.paper.published_tables import CELL, PROTOCOLS, Comparison, paper_table
from learn.paper_choices import page
from learn.paper_choices.analysis import Fit, Held
from learn.paper_choices.outcome import Outcome, reading
from learn.paper_choices.remains import rests, sentences
from learn.paper_choices.search import Trial

CLAIMS = {f"C{n}": n != 3 for n in range(1, 19)}


def tables(points):
    return {name: Comparison(paper_table(name).assign(ours=lambda c: c["paper"] - points)) for name in PROTOCOLS}


def outcome(**values):
    best = Trial(False, USUAL | values, 5.0, {}, {})
    intervals = {name: (0.9 * value, 1.1 * value) for name, value in best.values.items()}
    held = {key: Held(float(holds), ()) for key, holds in CLAIMS.items()} | {"C2": Held(0.4, ("window", "floor"))}
    cells = pd.concat({name: paper_table(name).set_index(CELL) for name in PROTOCOLS}, names=["table"]).index
    slopes = pd.DataFrame(0.0, cells, [each.name for each in CHOICES]).assign(window=1.0)
    drawn = Trial(True, USUAL, 9.0, {name: list(table.cells["ours"]) for name, table in tables(12).items()}, CLAIMS)
    return Outcome(
        CHOICES,
        [drawn, best],
        Fit(best.values, 0.1, intervals, 3),
        tables(10),
        tables(4),
        tables(3),
        CLAIMS,
        CLAIMS,
        held,
        slopes,
        {"C11": {"best S1": 0.9}},
    )


def test_the_file_has_the_fields_that_are_asked_for():
    fields = outcome(load_inertia=0.02).fields()
    assert list(fields) == ["before", "after", "unreduced", "rank_correlation", "choices", "claims"]
    assert fields["before"] == dict.fromkeys(PROTOCOLS, 10.0)
    assert fields["after"] == dict.fromkeys(PROTOCOLS, 4.0)
    assert fields["rank_correlation"] == 1
    assert fields["choices"]["load_inertia"] == {
        "value": 0.02,
        "interval": [pytest.approx(0.018), pytest.approx(0.022)],
    }
    assert fields["claims"]["C2"] == {"share": 0.4, "depends_on": ["window", "floor"]}


def test_the_answer_names_what_is_not_as_usual_and_nothing_else():
    found = outcome(load_inertia=0.02)
    assert found.answer.startswith(
        "The paper's chain has what ours lacks: inertia of output and load J_out: 0.02 kg m²"
    )
    assert found.answer.count("ours") == 2  # lacks, and one value
    assert "our values fit as well" in outcome().answer
    assert "other choices" not in found.answer
    assert "Of these intervals 1 hold our value" in outcome(load_inertia=0.95).answer


def test_a_table_that_the_fit_never_saw_may_contradict_it():
    found = outcome(load_inertia=0.02)
    assert found.judgement.endswith("So they support the fit, yet they are no blind test.")
    worse = replace(found, after={**tables(4), "table10": tables(13.5)["table10"]})
    assert worse.judgement.startswith("Further away than before: Table X (+3.5 points).")


def test_claims_are_read_by_how_they_hold():
    groups = reading(outcome().held, {"C3": {"one": 0.9, "two": 0.2}})
    assert groups["Hold on every plausible choice"].startswith("damping hardly shows in the signals (C1); a root crack")
    assert groups["Depend on a choice that the paper does not state"] == "stiffness shows in s0 alone (C2: window)"
    assert groups["Do not come out on any"] == "eccentricity distorts s1 and s3 (C3, 1 of 2 parts hold on most)"
    assert len(groups) == 3


def test_what_remains_names_the_choice_that_takes_most_and_what_it_costs():
    """All scores are 4 too low; a longer window lifts them by 1 for a standard deviation, two to the range's end."""
    found = rests(outcome(load_inertia=0.02), prior_weight=0.25)
    assert set(found["choice"]) == {"length of the window"}
    assert found["difference"].to_numpy() == pytest.approx(-4)
    assert found.loc[found["table"] == "table9", "adds"].sum() == pytest.approx(4)
    # The prior costs 0.25 * 2^2 / 2, and all cells come nearer by 2.
    assert set(found["why"]) == {"takes 2 points at an end of its range, and makes the fit 1.5 points better"}


def test_what_remains_is_said_of_each_table_that_stays_away():
    of_ix, of_x, order = sentences(outcome(load_inertia=0.02), rests(outcome(load_inertia=0.02), 0.25))
    assert of_ix.startswith("Table IX is 4.0 points off")
    assert of_x.endswith("The nearest of 1 sets of choices has VII 12.0, VIII 12.0, IX 12.0, X 12.0 points off.")
    assert order.startswith("The order of the classifiers agrees by 1.00")


def test_the_page_opens_with_the_answer_and_says_what_was_reached():
    text = page.page(outcome(load_inertia=0.02), CONFIG["prior_weight"])
    lead = text.split("<nav>")[0]
    conclusions, found = "Hold on every plausible choice", "The paper's chain has what ours lacks".replace("'", "&#39;")
    assert lead.index(conclusions) < lead.index(found) < lead.index("no blind test")
    assert lead.index("blind test") < text.index("of them on Selection 1") < text.index('id="pictures"')
    assert re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)', text) == []


def test_all_files_are_written_and_what_is_kept_has_every_cell(tmp_path, capsys):
    found = outcome(load_inertia=0.02)
    page.write(found, CONFIG, tmp_path)
    assert json.loads((tmp_path / "paper_choices.json").read_text()) == found.fields()
    kept = json.loads((tmp_path / "paper_choices" / "paper_choices.json").read_text())
    assert len(kept["cells"]) == sum(len(paper_table(name)) for name in PROTOCOLS)
    assert "J_out: 0.02" in (tmp_path / "paper_choices" / "paper_fitted.yaml").read_text()
    assert "error before: VII 10.0, VIII 10.0, IX 10.0, X 10.0 points; after: VII 4.0" in capsys.readouterr().out
