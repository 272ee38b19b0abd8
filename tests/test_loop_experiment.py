"""What to record next: as the bench stands, unless only something else decides the question."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import Bump, fitted_to

from swgsim.loop import experiment
from swgsim.loop.experiment import FEASIBLE, SEPARATED, easiest
from swgsim.loop.features import Layout
from swgsim.loop.model import Model

PLAIN, WARM = 0, len(FEASIBLE)


@pytest.mark.parametrize(
    ("plain", "warm", "chosen"),
    [
        (SEPARATED + 1, 10 * SEPARATED, PLAIN),  # decides the question, however much better another would
        (SEPARATED - 2, SEPARATED + 3, WARM),  # nearly as good, but does not decide it
        (9.0, 10.0, PLAIN),  # neither does
        (5.0, 10.0, WARM),
    ],
)
def test_the_easiest_recording_that_decides(plain, warm, chosen):
    separations = np.zeros(len(FEASIBLE) + 1)
    separations[[PLAIN, WARM]] = plain, warm
    assert easiest(separations) == chosen


def test_another_structure_makes_two_effects_uncertain_by_the_root_of_their_squares(monkeypatch):
    layout = Layout(("T_in", "s0"))
    fitted = fitted_to(layout, np.random.default_rng(1))
    model = replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0), Bump(2.0))))
    signatures = np.zeros((2, 1, len(layout)))
    signatures[:, 0, (layout.channel == "s0") & (layout.order == 2)] = np.array([[3.0, 4.0], [8.0, 6.0]])
    monkeypatch.setattr(experiment, "predict", lambda *_: -signatures)
    known, unknown = (
        experiment._tolerance(
            replace(fitted, calibrated=model, unit=replace(fitted.unit, structure=s)), (), np.zeros((1, len(layout)))
        )
        for s in (0.01, 0.3)
    )
    added = (unknown[0] ** 2).sum(axis=-1) - (known[0] ** 2).sum(axis=-1)
    np.testing.assert_allclose(added, np.where(layout.channel == "s0", 0.3**2 * (5.0**2 + 10.0**2), 0.0))
