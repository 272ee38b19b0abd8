"""A fit with further effects begins where earlier ones move freely, and ends with their form open."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import Bump, Wave, fitted_to

from swgsim.identification.data.features import Layout
from swgsim.identification.fit import fitting

FITTED = fitted_to(Layout(("s1", "s2")), np.random.default_rng(1), repeats=2)
ROWS = len(FITTED.offset)


@pytest.fixture
def fits(monkeypatch):
    """The fits asked for: the effects of each, and what else was given; the first ends somewhere else."""
    asked = []

    def fit(measured, unit, model, **given):
        asked.append((model.effects, given))
        return replace(FITTED, calibrated=replace(FITTED.calibrated, position={"bump 1: height": 3.0}))

    monkeypatch.setattr(fitting, "fit", fit)
    return asked


def test_the_form_of_earlier_effects_opens_once_they_have_moved_without_it(fits):
    """What was set free is so all along; and where parameters are counted from stays the same."""
    earlier = replace(FITTED.calibrated, model=FITTED.unit.model.plus(Bump(1.0)))
    now = replace(FITTED, calibrated=earlier).allowing(np.ones((ROWS, 1))).allowing_forms(np.eye(ROWS)[:, :3])
    fitting.extended(now, [Wave(2.0)])
    (ahead, closed), (then, opened) = fits
    assert ahead == then == (Bump(1.0), Wave(2.0))
    assert (closed["allowed"].free.shape[1], closed["allowed"].forms.shape[1], closed["turns"]) == (1, 0, 1)
    assert opened["allowed"] is now.allowed
    assert opened["position"] == {"bump 1: height": 3.0}
