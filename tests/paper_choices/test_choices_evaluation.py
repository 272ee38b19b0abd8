"""Cells and claims under given values: what is computed, and what a broken number of revolutions does."""

import numpy as np
import pytest
from paper_choices.study_configuration import CONFIG, USUAL

from learn.paper_choices.evaluation import SAMPLED, SEARCHED, claims, recordings, tables

pytestmark = pytest.mark.end_to_end
SMALL = {**CONFIG, "grid": {**CONFIG["grid"], "variants": 6, "positions": 2, "references": 1}, "mesh": {"sectors": 40}}
CLASSIFIERS = CONFIG["classifiers"] | {
    "mlp": CONFIG["classifiers"]["mlp"] | {"iterations": 2},
    "rf": CONFIG["classifiers"]["rf"] | {"trees": 5},
}


@pytest.fixture(scope="module")
def made():
    return recordings(SMALL, USUAL)


def test_draws_fill_all_cells_and_decide_all_claims(made):
    scored = tables(made, CLASSIFIERS, SAMPLED)
    assert not any(table.cells["ours"].isna().any() for table in scored.values())
    left_out = scored["table9"].cells.query("classifier == 'mlp' and features == 'selection_1'")
    assert left_out["ours"].nunique() == 1  # trained once, for the gear in the middle
    assert list(claims(made, scored, USUAL["disturbance"])) == [f"C{n}" for n in range(1, 19)]


def test_the_search_leaves_out_the_disturbed_tables_alone(made):
    scored = tables(made, CLASSIFIERS, SEARCHED)
    assert list(scored) == ["table7", "table9"]
    assert not any(table.cells["ours"].isna().any() for table in scored.values())


def test_bins_of_a_broken_number_of_revolutions_leak_and_order_lines_do_not(made):
    """A healthy gear has no odd orders but those of its small errors; the second bin lies between its lines."""
    values = USUAL | {"window": 50.0, "components": 4.0}
    cut, broken = (recordings(SMALL, values | {"whole_revolutions": whole}) for whole in (1.0, 0.0))
    spread = [
        np.asarray(each.selections["selection_3"].learning_set(each.blocks["clean"]).features)[:, 0].std()
        for each in (cut, broken)
    ]
    assert spread[1] < spread[0] / 2  # the divisor of eq. (7) is no longer nearly zero
