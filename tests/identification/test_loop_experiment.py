"""What to record next: as the bench stands, unless only something else decides the question."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import fitted_to
from scipy.linalg import block_diag

from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.report import next_experiment as experiment
from swgsim.identification.report.next_experiment import FEASIBLE, SEPARATED, easiest

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


@pytest.mark.parametrize("recordings", [1, 6])
def test_separation_is_what_all_recordings_together_leave_of_the_difference(monkeypatch, recordings):
    """By dense matrices of the rows there are and the mean of those to come."""
    layout, rng = Layout(("T_in", "s0")), np.random.default_rng(2)
    fitted = fitted_to(layout, rng)
    measured, many = fitted.measured, len(fitted.measured.situations) + len(FEASIBLE) * len(experiment.CONDITIONS)
    directions, moved = rng.standard_normal((many, len(layout), 3)), rng.standard_normal((many, len(layout)))
    single = rng.standard_normal((many, len(layout), 2))
    monkeypatch.setattr(experiment, "_directions", lambda _, situations: (0 * moved, directions))
    monkeypatch.setattr(experiment, "predict", lambda models, *_, **__: np.array([moved]))
    monkeypatch.setattr(experiment.scatter, "directions", lambda _, situations, __: single[-len(situations) :])
    scatter = replace(fitted.scatter, sd={"one": 0.5, "other": 2.0})
    free = rng.standard_normal((measured.values.size, 1))  # a disturbance that was set apart tells nothing
    fitted = replace(fitted, scatter=scatter, allowed=fitted.allowed._replace(free=free))
    further = experiment._PlannedRecordings.of(fitted, [Model(GEAR)])
    found = further.separations(recordings)[4, 0]

    new = len(measured.situations) + 4
    of_session = measured.further("planned", further.candidates, 0 * moved[-60:]).session_columns(0 * moved[-60:])
    alone = single[new] * [0.5, 2.0]
    shared = of_session.reshape(60, len(layout), -1)[4]
    to_come = shared @ shared.T + (alone @ alone.T + np.diag(np.median(measured.variance, axis=0))) / recordings
    errors = fitted.errors
    dense = block_diag(np.diag(errors.variance) + errors.columns @ errors.columns.T + free @ free.T, to_come)
    C = np.vstack([measured.rows(directions[: len(measured.situations)]), directions[new]])
    d = np.concatenate([measured.rows(moved[: len(measured.situations)]), moved[new]])
    assert found == pytest.approx(d @ np.linalg.solve(dense + C @ C.T, d), rel=1e-8)
