"""Intervals cover known true values, and resampling has the variance of gears."""

import gc

import numpy as np
import pandas as pd
import pytest

from learn.evaluation.bootstrap import (
    difference_to,
    gear_bootstrap,
    gear_errors,
    mean_error,
    paired_comparison,
    ratio_to,
    resampled_means,
    specimens,
)
from learn.evaluation.decisions import decisions
from swgsim.common.seeds import generator
from swgsim.storage.labelled_signals import CLASSES

LABELS = CLASSES[:2]


def errors(rng, gears=8, variants=3, spread=5.0, means=(20.0, 20.0), labels=LABELS):
    """Errors of methods m0, m1, ... with independent normal deviations per gear and, of half the size, per specimen."""
    rows = [(g, label, v) for g in range(gears) for label in labels for v in range(variants)]
    table = pd.DataFrame(rows, columns=["gear", "label", "variant"])
    for number, mean in enumerate(means):
        per_gear = np.repeat(rng.normal(0, spread, gears), len(labels) * variants)
        table[f"m{number}"] = mean + per_gear + rng.normal(0, spread / 2, len(table))
    return table


def test_error_of_a_specimen_is_its_share_of_wrong_recordings():
    predicted = ["healthy", "reduced_damping", "healthy", "healthy"]
    rows = {"gear": 1, "label": "healthy", "variant": [0, 0, 0, 1], "n_in_rpm": [1, 2, 3, 1]}
    table = pd.DataFrame({**rows, **{c: [float(p == c) for p in predicted] for c in CLASSES}})
    np.testing.assert_array_equal(decisions(table), predicted)
    assert specimens(table)["error"].tolist() == pytest.approx([100 / 3, 0])
    with pytest.raises(ValueError, match="row 1: probabilities"):
        decisions(pd.DataFrame({c: [0.1, np.nan] for c in CLASSES}))


def test_classes_weigh_the_same_whatever_their_number_of_specimens():
    table = pd.DataFrame(
        {"gear": 1, "label": ["a", "a", "a", "b"], "variant": [0, 1, 2, 0], "m": [0.0, 0.0, 0.0, 40.0]}
    )
    assert gear_errors(table).loc[1, "m"] == pytest.approx(20)


def all_three(means):
    """Mean error, difference and ratio of m1 at once, so that one bootstrap serves all."""
    parts = {"mean": mean_error(means)["m1"], "difference": difference_to("m0")(means)["m1"]}
    return pd.DataFrame({**parts, "ratio": ratio_to("m0")(means)["m1"]})


@pytest.mark.end_to_end
@pytest.mark.slow
def test_intervals_cover_the_truth():
    rng, true = generator("coverage"), np.array([30, 10, 1.5])
    hits = np.zeros(3)
    for _ in range(200):
        interval = gear_bootstrap(errors(rng, variants=2, means=(20.0, 30.0)), all_three, rng, resamples=300)
        hits += (interval["low"] <= true) & (true <= interval["high"])
    assert (hits / 200).min() >= 0.88
    assert (hits / 200).max() <= 0.99


@pytest.fixture
def little_garbage():
    """Statsmodels collects garbage in every correction; what is loaded already need not be searched each time."""
    gc.freeze()


@pytest.mark.end_to_end
@pytest.mark.slow
@pytest.mark.usefixtures("little_garbage")
def test_null_is_rejected_at_most_as_often_as_promised():
    rng = generator("null")
    tables = (errors(rng, variants=1, labels=LABELS[:1], means=(20.0, 20.0, 20.0)) for _ in range(150))
    smallest = np.array([paired_comparison(table, "m0", rng, resamples=1500)["p_holm"].min() for table in tables])
    assert np.mean(smallest < 0.05) <= 0.05 + 2 * np.sqrt(0.05 * 0.95 / 150)
    assert np.mean(smallest < 0.5) >= 0.25


def test_a_true_difference_is_found():
    rng = generator("alternative")
    comparison = paired_comparison(errors(rng, gears=15, means=(20.0, 20.0, 5.0)), "m0", rng)
    assert comparison.loc["m2", "p_holm"] < 0.01
    assert comparison.loc["m2", "high"] < 0
    assert comparison.loc["m1", "p_holm"] > 0.05
    assert comparison.loc["m2", "p_holm"] == pytest.approx(2 * comparison.loc["m2", "p"])


def test_resampling_has_the_variance_of_a_study_on_other_gears_and_specimens():
    """Drawing the specimens too would give 1.6 times this variance, as their chance is in the gears' errors already."""
    rng, gears, resampled, found = generator("nesting"), 10, [], []
    for _ in range(300):
        table = errors(rng, gears, variants=4, spread=2.0, labels=LABELS[:1], means=(20.0,))
        table["m0"] += rng.normal(0, 10, len(table))
        found.append(float(gear_errors(table)["m0"].mean()))
        resampled.append(float(resampled_means(table, rng, resamples=300)["m0"].var()))
    assert np.mean(resampled) * gears / (gears - 1) == pytest.approx(np.var(found, ddof=1), rel=0.2)


def test_a_gear_is_drawn_with_all_of_its_specimens():
    rows = [(g, label, v) for g in range(5) for label in LABELS for v in range(3)]
    table = pd.DataFrame(rows, columns=["gear", "label", "variant"])
    table["m"] = 10.0 ** table["gear"] * (table["label"] == LABELS[1]) * table["variant"]
    of_one_gear = np.array([10.0**gear / 2 for gear in range(5)])
    means = resampled_means(table, generator("nested"), resamples=300)["m"].to_numpy() * 5
    sums = np.array(np.meshgrid(*[np.arange(6)] * 5)).reshape(5, -1)
    allowed = of_one_gear @ sums[:, sums.sum(axis=0) == 5]
    assert np.abs(means[:, None] - allowed).min(axis=1).max() < 1e-9


def test_methods_share_their_draws():
    table = errors(generator("shared"), means=(20.0,))
    table = table.assign(worse=table["m0"] + 3, same=table["m0"])
    comparison = paired_comparison(table, "m0", generator("shared draws"), resamples=200)
    assert comparison.loc["worse", ["value", "low", "high"]].to_numpy(dtype=float) == pytest.approx([3, 3, 3])
    assert comparison.loc["worse", "better_gears"] == 0
    assert comparison.loc["same", "p"] == 1


def test_three_gears_give_numbers_but_no_interval():
    table = errors(generator("three"), gears=3)
    comparison = paired_comparison(table, "m0", generator("p")).loc["m1"]
    assert np.isfinite(comparison["value"])
    assert comparison[["low", "high", "p", "p_holm"]].isna().all()
    assert gear_bootstrap(table, mean_error, generator("p"))[["low", "high"]].isna().to_numpy().all()


def test_reference_without_errors_gives_an_open_ratio():
    table = errors(generator("perfect"), means=(20.0,)).assign(perfect=0.0)
    ratio = gear_bootstrap(table, ratio_to("perfect"), generator("p"), resamples=200).loc["m0"]
    assert np.isinf(ratio["value"])
    assert np.isinf(ratio["high"])


def test_unpaired_tables_are_refused():
    table = errors(generator("unpaired"), gears=5)
    with pytest.raises(ValueError, match="specimen 0, healthy, 0 has two rows"):
        gear_errors(pd.concat([table, table.iloc[:1]]))
    with pytest.raises(ValueError, match="judge it by all methods or none"):
        gear_errors(table.assign(m1=table["m1"].where(table["gear"] > 0)))
    with pytest.raises(ValueError, match="reference 'best' is not among the methods"):
        paired_comparison(table, "best", generator("p"))
