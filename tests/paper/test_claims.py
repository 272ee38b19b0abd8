"""Claims: what is measured follows the physics, and a table decides each claim either way."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings

from learn.paper import claims as judged
from learn.paper.feature_claims import feature_claims, features_of
from learn.paper.published_tables import CELL, PROTOCOLS, Comparison, paper_table
from swgsim.gear.gear import Gear, Transmission
from swgsim.studies import claims
from swgsim.studies.examples import Subject

pytestmark = pytest.mark.end_to_end
SUBJECT = Subject((Gear(),), sectors=40)
FEATURES = features_of([recordings(variants=12)])


def table(name, cells=None):
    """The paper's own figures as ours, but for the given cells; gaps of Table VIII are filled within its bounds."""
    data = paper_table(name)
    step = data["relation"].map({"about": 0.0, "above": 1.0, "at most": -1.0})
    data = data.assign(ours=data["paper"] + step)
    for key, score in (cells or {}).items():
        data.loc[pd.MultiIndex.from_frame(data[CELL]).isin([key]), "ours"] = score
    return Comparison(data)


def verdicts(**changed):
    tables = {name: table(name, changed.get(name)) for name in PROTOCOLS}
    return {f.key: f for f in judged.table_claims(tables, FEATURES, disturbance=3e-4)}


def test_the_papers_own_figures_hold_all_claims_of_the_tables():
    found = verdicts()
    assert list(found) == [f"C{n}" for n in range(11, 19)]
    assert [key for key, finding in found.items() if not finding.holds] == []


@pytest.mark.parametrize(
    ("key", "name", "cell", "score"),
    [
        ("C11", "table7", ("selection_1", "test", "knn"), 100.0),
        ("C12", "table7", ("selection_2", "test", "mlp"), 84.1),
        ("C13", "table7", ("selection_3", "test", "nb"), 88.0),
        ("C14", "table7", ("selection_2", "test", "svm"), 70.0),
        ("C15", "table8", ("selection_1", "test", "rf"), 90.0),
        ("C16", "table9", ("selection_1", "1,2->3", "rf"), 91.9),
        ("C17", "table10", ("selection_1", "2,3->1", "knn"), 75.1),
    ],
)
def test_one_score_off_breaks_the_claim_and_the_note_says_which(key, name, cell, score):
    finding = verdicts(**{name: {cell: score}})[key]
    assert not finding.holds
    assert "Against" in finding.note


def test_forest_that_is_good_enough_breaks_c18():
    cells = {("selection_3", row, "rf"): 99.0 for row in judged.GEARS}
    finding = verdicts(table10=cells)["C18"]
    assert not finding.holds
    assert "RF Table X S3 at worst 99.0, paper below 95" in finding.note


def test_more_viscous_gear_breaks_c6():
    viscous = Gear(transmission=replace(Transmission(), b1=2 * Transmission().b1))
    assert claims.efficiency(SUBJECT).holds
    assert not claims.efficiency(replace(SUBJECT, gears=(viscous,))).holds


def test_perfect_gauges_make_opposite_signals_equal():
    finding = claims.opposite_gauges(SUBJECT)
    assert finding.holds
    skewed = replace(Gear().gauges, gain=(1.0, 1.3, 1.0, 1.0, 1.0))
    assert not claims.opposite_gauges(replace(SUBJECT, gears=(Gear(gauges=skewed),))).holds


def test_amplitude_is_half_the_swing():
    assert claims.amplitude(np.array([[1.0, -3.0, 2.0], [0.5, 0.5, 0.5]])) == pytest.approx([2.5, 0])


def test_fabricated_faults_depart_and_the_fourth_root_opens_the_gap():
    c9, c10 = feature_claims(FEATURES)
    assert (c9.key, c10.key) == ("C9", "C10")
    assert "eccentric wave generator 100 %" in c9.figure
    assert c10.holds


def test_features_keep_the_rows_of_the_samples():
    blocks = [recordings(variants=4)]
    features = features_of(blocks)
    assert len(features.departure) == len(features.relative) == len(features.table) == len(blocks[0].samples)
    healthy = (features.table["label"] == "healthy").to_numpy()
    assert features.departure[healthy] == pytest.approx(0, abs=1e-9)
    assert isinstance(features.table, pd.DataFrame)
