"""Detection on made-up gears with a known probability of detection."""

import numpy as np
import pandas as pd
import pytest

from learn.evaluation.detection import alarms, detection_table, false_alarm_rate, worst_cell
from learn.evaluation.detection_curve import DetectionCurve, detection
from learn.protocols.fault_size import SIZES, size
from swgsim.common.seeds import generator
from swgsim.dataset.faults import FAULTS
from swgsim.storage.labelled_signals import CLASSES

A50, SLOPE = 0.1, 4.0


def hits_and_misses(rng, gears=20, per_gear=60, spread=0.0):
    """Sizes, hits and gears; log-odds of detection are SLOPE log(size / A50) plus a deviation of each gear."""
    gear = np.repeat(np.arange(gears), per_gear)
    sizes = np.exp(rng.uniform(np.log(0.01), np.log(1), len(gear)))
    odds = SLOPE * np.log(sizes / A50) + rng.normal(0, spread, gears)[gear]
    return sizes, rng.random(len(gear)) < 1 / (1 + np.exp(-odds)), gear


def rate_of(made):
    return false_alarm_rate(made, made["healthy"].to_numpy() < 0.5)


def table(rows):
    """Predictions from (gear, label, variant, severity, speed, predicted class)."""
    names = ["gear", "label", "variant", "severity", "n_in_rpm", "predicted"]
    made = pd.DataFrame(rows, columns=names).assign(T_out_nm=7.0)
    return made.assign(**{name: (made["predicted"] == name).astype(float) for name in CLASSES})


def test_every_fault_has_a_size_that_grows_with_damage():
    assert set(SIZES) == set(FAULTS)
    mild = {"reduced_damping": 0.9, "reduced_stiffness": 0.9, "eccentric_wave_generator": 2e-5,
            "root_tooth_crack": 0.1, "tip_tooth_crack": 0.5}  # fmt: skip
    severe = {"reduced_damping": 0.7, "reduced_stiffness": 0.8, "eccentric_wave_generator": 1e-4,
              "root_tooth_crack": 0.01, "tip_tooth_crack": 1.0}  # fmt: skip
    for label in SIZES:
        assert np.diff(size(label, np.array([mild[label], severe[label]])))[0] > 0
    with pytest.raises(ValueError, match="'healthy' has no fault size"):
        size("healthy", np.array([np.nan]))
    with pytest.raises(ValueError, match="size 0, must be above 0"):
        size("reduced_damping", np.array([1.0]))


def test_known_curve_is_found_again():
    fitted = detection(*hits_and_misses(generator("curve"), per_gear=400))
    assert fitted.reason == ""
    assert fitted.a90 == pytest.approx(A50 * 9 ** (1 / SLOPE), rel=0.08)
    assert fitted.a90 < fitted.a90_95 < 1.15 * fitted.a90
    curve, terms = fitted.curve, np.array([1, np.log(fitted.a90_95)])
    bound = terms @ [curve.intercept, curve.slope] - curve.quantile * np.sqrt(terms @ curve.covariance @ terms)
    assert bound == pytest.approx(np.log(9))


@pytest.mark.end_to_end
def test_sure_size_is_above_the_true_one_in_95_percent():
    rng, true = generator("sure"), A50 * 9 ** (1 / SLOPE)
    fits = [detection(*hits_and_misses(rng, gears=20, per_gear=40)) for _ in range(200)]
    assert 0.9 <= np.mean([fit.a90_95 > true for fit in fits]) <= 0.99


def test_gears_that_differ_widen_the_bound():
    sizes, hits, gears = hits_and_misses(generator("clusters"), spread=2.0)
    clustered = detection(sizes, hits, gears).curve.covariance
    independent = detection(sizes, hits, np.arange(len(sizes))).curve.covariance
    assert clustered[0, 0] > 2 * independent[0, 0]


@pytest.mark.parametrize(
    ("sizes", "hits", "reason"),
    [
        ([0.1, 0.2, 0.3], [True, True, True], "below the smallest size tried, 0.1 mm"),
        ([0.1, 0.2, 0.3], [False, False, False], "not reached: never found up to the largest size tried, 0.3 mm"),
        ([0.1, 0.2, 0.3], [False, True, True], "between 0.1 and 0.2 mm"),
        ([0.1, 0.2, 0.3], [True, True, False], "not reached: every hit is smaller"),
        ([0.2, 0.2, 0.2], [True, False, True], "one size tried only, 0.2 mm: 67 % found"),
    ],
)
def test_no_curve_where_none_can_be_fitted(sizes, hits, reason):
    fitted = detection(np.array(sizes), np.array(hits), np.arange(3), " mm")
    assert fitted.reasons["a90"].startswith(reason)
    assert set(fitted.reasons) == {"a90", "a90_95"}
    assert fitted.curve is None
    assert np.isnan([fitted.a90, fitted.a90_95]).all()


def test_sizes_outside_those_tried_are_not_given():
    sizes, hits, gears = hits_and_misses(generator("outside"))
    small = sizes < 0.12
    fitted = detection(sizes[small], hits[small], gears[small])
    assert np.isnan(fitted.a90)
    assert "a90: not reached up to the largest size tried, 0.12" in fitted.reason


def test_falling_detection_few_gears_and_a_slope_that_may_be_zero_are_named():
    sizes, hits, gears = hits_and_misses(generator("falls"))
    assert "does not grow with size" in detection(sizes, ~hits, gears).reason
    fitted = detection(*hits_and_misses(generator("three"), gears=3))
    assert np.isfinite(fitted.a90)
    assert fitted.reason == "a90_95: fewer than 5 gears, no confidence bound"
    assert DetectionCurve(0.0, 1.0, np.eye(2), 1.7).sure_size_at(0.9) == np.inf


def test_table_has_a_row_per_fault():
    """Any fault counts, right or wrong."""
    sizes, hits, gears = hits_and_misses(generator("table"))
    rows = [
        (gear, "tip_tooth_crack", 0, lost, 2000, "root_tooth_crack" if hit else "healthy")
        for gear, lost, hit in zip(gears, sizes, hits, strict=True)
    ]
    made = table([*rows, (1, "healthy", 0, np.nan, 2000, "healthy")])
    (found,) = detection_table(made, made["healthy"].to_numpy() < 0.5).to_dict("records")
    assert (found["label"], found["hits"], found["reason"]) == ("tip_tooth_crack", 100 * hits.mean(), "")
    assert found["a90"] == detection(sizes, hits, gears).a90


def healthy(gears, alarm):
    """20 healthy specimens per gear at two speeds; `alarm(gear, variant)` says which alarm."""
    return table([
        (g, "healthy", v, np.nan, speed, "tip_tooth_crack" if alarm(g, v) else "healthy")
        for g in range(gears) for v in range(20) for speed in (1, 2)
    ])  # fmt: skip


def test_false_alarms_of_one_gear_are_less_sure_than_spread_ones():
    spread = rate_of(healthy(10, lambda gear, variant: variant == 0))
    one = rate_of(healthy(10, lambda gear, variant: gear == 0 and variant < 10))
    assert spread["rate"] == one["rate"] == pytest.approx(5)
    assert one["high"] > 2 * spread["high"]
    assert (spread["alarming_gears"], one["alarming_gears"]) == (10, 1)


def test_no_false_alarm_is_no_proof_of_none():
    rate = rate_of(healthy(10, lambda gear, variant: False))
    assert rate["rate"] == rate["low"] == 0
    assert rate["high"] == pytest.approx(100 * 3.8415 / (200 + 3.8415), rel=1e-3)  # Wilson, 0 of 200 specimens
    assert np.isnan(rate_of(healthy(3, lambda gear, variant: False))["high"])
    with pytest.raises(ValueError, match="no healthy recording"):
        rate_of(table([(1, "tip_tooth_crack", 0, 1.0, 2000, "healthy")]))


def test_alarms_keep_their_rate_on_gears_that_did_not_set_the_limit():
    rng, rows = generator("alarms"), 400
    made = pd.DataFrame({"gear": np.repeat(np.arange(10), rows), "label": "healthy", "healthy": rng.random(10 * rows)})
    rate = alarms(made, 0.05).mean()
    assert rate == pytest.approx(0.05, abs=4 * np.sqrt(0.05 * 0.95 / len(made)))
    sick = pd.concat([made, made[:5].assign(label="tip_tooth_crack", healthy=[0.0, 0.001, 0.2, 0.5, 0.9])])
    assert alarms(sick, 0.05)[-5:].tolist() == [True, True, False, False, False]
    assert not alarms(made[made["gear"] < 1], 0.05).any()  # no other gear tells what is usual


def test_worst_cell_is_found():
    rows = [(1, label, v, 1.0, speed, label) for label in CLASSES for v in range(4) for speed in (2000, 4000)]
    rows[-1] = (*rows[-1][:5], "healthy")
    worst = worst_cell(table(rows))
    assert worst.to_dict() == {
        "n_in_rpm": 4000, "T_out_nm": 7.0, "label": "tip_tooth_crack", "recall": 75.0, "recordings": 4
    }  # fmt: skip
