"""Features against signals whose means, variances and spectra are known in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from fabricated import recordings

from learn.inputs.features import Selection
from learn.inputs.references import healthy_reference

SELECTIONS = (
    Selection("selection_1", statistics=True, spectrum="none", efficiency="eta_rel"),
    Selection("selection_2", statistics=True, spectrum="gauges", efficiency="eta_rel"),
    Selection("selection_3", statistics=False, spectrum="differences", efficiency="eta2_rel"),
)


def features(data, selection):
    return selection.learning_set([data]).features


def changed(original, rows, **columns):
    """The recordings with other facts in some rows."""
    table = original.table.copy()
    for name, value in columns.items():
        table.loc[rows, name] = value
    return replace(original, table=table)


def test_samples_after_the_last_whole_revolution_do_not_count():
    whole = recordings(gears=1, length=600)
    longer = recordings(gears=1, length=640)
    for selection in SELECTIONS:
        np.testing.assert_allclose(features(longer, selection), features(whole, selection), atol=1e-2)


def test_short_windows_and_orders_above_half_the_sampling_rate_are_refused():
    with pytest.raises(ValueError, match=r"250 samples holds 0.83 revolutions at 2000 rpm.*record 300 samples"):
        features(recordings(gears=1, length=250), SELECTIONS[0])
    with pytest.raises(ValueError, match=r"order 75 at 4000 rpm lies at 5000 Hz, the limit is .* 5000 Hz"):
        features(recordings(gears=1), replace(SELECTIONS[1], orders=75))


@pytest.mark.parametrize(("selection", "count"), [(SELECTIONS[0], 11), (SELECTIONS[1], 41), (SELECTIONS[2], 13)])
def test_table_3_in_shape_and_names(selection, count):
    data = recordings(gears=2)
    assert len(selection.names) == count
    assert features(data, selection).shape == (len(data.samples), count)


def test_healthy_samples_are_exactly_their_own_reference():
    data = recordings()
    healthy = (data.samples.table["label"] == "healthy").to_numpy()
    np.testing.assert_array_equal(features(data, SELECTIONS[0])[healthy], 1.0)
    np.testing.assert_allclose(features(data, SELECTIONS[2])[healthy, :-1], 1.0, atol=1e-9)
    np.testing.assert_array_equal(features(data, SELECTIONS[2])[healthy, -1], 0.0)  # eq. 9


def test_relative_mean_and_variance_of_a_scaled_signal():
    data = recordings(gears=1, variants=1)
    samples = ~data.table["reference"].to_numpy()
    scaled = replace(data, signals=np.where(samples[:, None, None], 2 * data.signals, data.signals))
    before, after = features(data, SELECTIONS[0]), features(scaled, SELECTIONS[0])
    np.testing.assert_allclose(after[:, :5], 2 * before[:, :5], rtol=1e-6)
    np.testing.assert_allclose(after[:, 5:10], 4 * before[:, 5:10], rtol=1e-6)


def test_efficiency_is_relative_to_the_same_gear_and_operating_point():
    data = recordings(gears=1, variants=1)
    samples = ~data.table["reference"]
    better = changed(data, samples, efficiency=data.table.loc[samples, "efficiency"] * 1.0016)
    healthy = (data.samples.table["label"] == "healthy").to_numpy()
    np.testing.assert_allclose(features(better, SELECTIONS[0])[healthy, -1], 1.0016)
    np.testing.assert_allclose(features(better, SELECTIONS[2])[healthy, -1], 0.2)  # 0.0016 ** (1 / 4)


def test_common_signal_of_opposite_gauges_drops_out_of_selection_3():
    data = recordings(gears=2)
    common = 0.1 * np.cos(np.arange(600) / 9).astype(np.float32)
    shifted = replace(data, signals=data.signals + common)
    difference = features(shifted, SELECTIONS[2]) - features(data, SELECTIONS[2])
    assert np.abs(difference).max() < 0.1  # of float32 rounding over the floor


def test_floor_bounds_the_quotient_where_the_healthy_value_vanishes():
    data = recordings(gears=1)
    data = replace(data, signals=data.signals - data.signals.mean(axis=2, keepdims=True))
    coarse = features(data, replace(SELECTIONS[0], floor=1e-3))
    fine = features(data, replace(SELECTIONS[0], floor=1e-6))
    np.testing.assert_allclose(coarse[:, :5] - 1, 1e-3 * (fine[:, :5] - 1), rtol=1e-6)


def test_reference_is_the_mean_over_its_acquisitions_of_each_feature():
    data = recordings(gears=1, references=3, disturbance=0.01)
    references, samples = data.references, data.samples
    values = np.arange(len(references), dtype=float)[:, None]
    first = (references.table[["n_in_rpm", "T_out_nm"]] == [2000.0, 7.0]).all(axis=1).to_numpy()
    rows = (samples.table[["n_in_rpm", "T_out_nm"]] == [2000.0, 7.0]).all(axis=1).to_numpy()
    found = healthy_reference(values, references.table, samples.table)
    np.testing.assert_allclose(found[rows], values[first].mean())
