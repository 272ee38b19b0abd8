"""Every picture that judges methods is drawn, also where there is little to draw."""

import numpy as np
import pandas as pd
import pytest
from learn.transfer_report.novelty import Novelty
from learn.transfer_report.novelty_figure import novelty_beside_error

from learn.evaluation.bootstrap import difference_to, gear_errors, paired_comparison
from learn.evaluation.detection import recall_by_cell
from learn.evaluation.probability_calibration import reliability
from learn.evaluation.selective import risk_coverage
from learn.protocols.fault_size import SIZES
from learn.transfer_report import heat_figures
from learn.transfer_report import judging_figures as figures
from swgsim.common.seeds import generator
from swgsim.storage.gauge_set import CLASSES


def predictions():
    """Six gears, twelve severities per fault; everything is recognised but the tip crack at 4000 rpm."""
    rows = [
        (gear, label, v, np.nan if label == "healthy" else (v + 1) / 13, speed, 7.0, *(
            float(c == ("healthy" if label == "tip_tooth_crack" and speed == 4000 else label)) for c in CLASSES
        ))
        for gear in range(6) for label in CLASSES for v in range(12) for speed in (2000.0, 4000.0)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=["gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm", *CLASSES])


def drawn(picture):
    assert picture.title
    return picture.png[:8] == b"\x89PNG\r\n\x1a\n" and len(picture.png) > 10_000


@pytest.mark.parametrize("hit", ["some", "all", "none"])
def test_detection_is_drawn_with_and_without_a_curve(hit):
    table = predictions()
    chance = {"some": table["severity"].fillna(0).to_numpy(), "all": np.ones(len(table)), "none": np.zeros(len(table))}
    assert drawn(figures.pod_curves(table, generator("hits").random(len(table)) < chance[hit]))


def test_every_fault_size_has_an_axis():
    assert set(figures.SIZE_AXES) == set(SIZES)


def test_calibration_and_selection_are_drawn():
    probabilities = generator("probabilities").dirichlet(np.ones(6), 300)
    y = generator("classes").integers(6, size=300)
    assert drawn(
        figures.reliability_diagram({"one": reliability(probabilities, y), "two": reliability(probabilities, y)})
    )
    curve = risk_coverage(probabilities.max(axis=1), probabilities.argmax(axis=1) == y)
    assert drawn(figures.risk_coverage_curves({"one": curve}))


def test_importance_is_drawn_even_where_nothing_matters():
    rows = [(group, label, 0.0, 0.0) for group in ("s0", "s1") for label in CLASSES]
    nothing = pd.DataFrame(rows, columns=["group", "label", "drop", "spread"])
    assert drawn(heat_figures.importance_map(nothing))
    assert drawn(heat_figures.line_map(nothing))


@pytest.mark.parametrize("foreign", [None, pd.Series([9.0, 12.0])])
def test_novelty_is_drawn_with_and_without_foreign_gears(foreign):
    usual = pd.DataFrame({"novelty": [1.0, 1.2, 0.9], "error": [10.0, 20.0, 0.0]})
    assert drawn(novelty_beside_error(Novelty(usual, foreign), "any method"))


def test_caption_names_the_worst_cell():
    picture = heat_figures.cell_recall(recall_by_cell(predictions()))
    assert drawn(picture)
    assert "tip tooth crack at 4000 rpm, 7 N m with 0.0 %" in picture.caption


@pytest.mark.parametrize("gears", [3, 8])
def test_comparison_is_drawn_with_and_without_intervals(gears):
    rng = generator("comparison", gears)
    rows = [(gear, "healthy", v, *rng.uniform(0, 100, 3)) for gear in range(gears) for v in range(3)]
    errors = pd.DataFrame(rows, columns=["gear", "label", "variant", "forest", "network", "regression"])
    comparison = paired_comparison(errors, "forest", rng, resamples=100)
    picture = figures.difference_forest(comparison, difference_to("forest")(gear_errors(errors)), "forest")
    assert drawn(picture)
    assert "forest" in picture.title
