"""What all representations have in common: references, blocks, and limits of their options."""

from dataclasses import replace

import numpy as np
import pytest
from fabricated import recordings

from learn.inputs.features import Selection
from learn.inputs.harmonics import Harmonics
from learn.inputs.inputs import Representation
from learn.inputs.lines import ResidualLines
from learn.inputs.signals import Signals

SELECTION = Selection("selection_2", statistics=True, spectrum="gauges", efficiency="eta_rel")
HARMONICS, LINES, SIGNALS = Harmonics("harmonics", 6), ResidualLines("lines", 6), Signals("residual", 16, 6)
BOTH = Signals("residual_with_reference", 16, 6)
all_of_them = pytest.mark.parametrize(
    "representation", [SELECTION, HARMONICS, LINES, SIGNALS, BOTH], ids=lambda r: r.name
)


@all_of_them
def test_blocks_give_what_the_whole_gives_and_samples_do_not_depend_on_each_other(representation):
    data = recordings(gears=2, disturbance=0.01)
    whole = representation.learning_set([data])
    parts = representation.learning_set([data.where(rows) for rows in np.array_split(np.arange(len(data)), 7)])
    assert isinstance(representation, Representation)
    assert hash(representation) == hash(replace(representation))
    assert len(set(whole.names)) == whole.features.shape[1]
    assert np.isfinite(whole.features).all()
    assert parts.table.equals(whole.table)
    np.testing.assert_allclose(parts.features, whole.features, rtol=1e-9, atol=1e-9)
    references, samples = (np.flatnonzero(data.table["reference"] == is_reference) for is_reference in (True, False))
    single = representation.learning_set([data.where(np.append(references, samples[40]))])
    np.testing.assert_allclose(single.features[0], whole.features[40], rtol=1e-9, atol=1e-9)


@all_of_them
def test_missing_references_and_impossible_efficiencies_are_named(representation):
    data = recordings(gears=2)
    lost = data.table["reference"] & (data.table["gear"] == 2) & (data.table["n_in_rpm"] == 4000.0)
    with pytest.raises(ValueError, match=r"gear 2 has no healthy reference at 4000 rpm and 7 N m"):
        representation.learning_set([data.where(~lost)])
    table = data.table.assign(efficiency=data.table["efficiency"].where(~data.table["reference"], -0.1))
    with pytest.raises(ValueError, match=r"healthy reference efficiency -0.1 found, .* above 0"):
        representation.learning_set([replace(data, table=table)])


@pytest.mark.parametrize(
    ("representation", "change", "message"),
    [
        (SELECTION, {"spectrum": "sums"}, "unknown choice 'sums' of spectrum; choose from none, gauges, differences"),
        (
            SELECTION,
            {"efficiency": "eta"},
            "unknown choice 'eta' of efficiency; choose from none, eta_rel, eta2_rel, both",
        ),
        (SELECTION, {"orders": 0}, "orders of selection.* is 0, must be an integer from 1"),
        (SELECTION, {"floor": 0.0}, "floor of selection.* is 0.0, must be a finite number above 0"),
        (HARMONICS, {"orders": 3}, "orders of harmonics is 3, must be an integer from 4"),
        (LINES, {"orders": 0}, "orders of lines is 0, must be an integer from 1"),
        (SIGNALS, {"name": "sum"}, "unknown choice 'sum' of the signals; choose from raw, template, differenced"),
        (SIGNALS, {"reference": False}, "is relative to a healthy reference: reference=true, or features=raw"),
        (SIGNALS, {"points": 7}, "points of residual is 7, must be an integer from 8 to 4096"),
        (SIGNALS, {"points": 5000}, "points of residual is 5000, must be an integer from 8 to 4096"),
        (SIGNALS, {"orders": 0}, "orders of residual is 0, must be an integer from 1 to 7"),
        (SIGNALS, {"orders": 8}, "orders of residual is 8, must be an integer from 1 to 7"),
        *((r, {"acquisitions": 0}, f"acquisitions of {r.name} is 0, must be an integer") for r in (LINES, SIGNALS)),
    ],
)
def test_options_out_of_their_limits_are_refused(representation, change, message):
    with pytest.raises(ValueError, match=message):
        replace(representation, **change)
