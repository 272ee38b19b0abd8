"""Declared parameters are fitted as likely as their spread allows."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import POINTS, Bump
from scipy.optimize import nnls

from swgsim.chain import NoSteadyState
from swgsim.common.seeds import generator
from swgsim.effects.clipping import Clipping
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import W0_LIMITS, KinematicError
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.fit.map_fit import DIFFERENCE, calibrate, linearised
from swgsim.identification.fit.priors import MOST_RATIO, Declared, at, of_effects, of_unit

LAYOUT = Layout(("s0", "s1"))
SITUATIONS = tuple(Situation(point, Conditions()) for point in POINTS)
START = Model(GEAR, (Bump(0.0), Bump(0.0)))


def height(number: int, sd: float = 1.0, low: float = -np.inf, high: float = np.inf) -> Declared:
    """The height of one of the model's effects as a parameter."""

    def moved(model: Model, to: float) -> Model:
        effects = list(model.effects)
        effects[number] = Bump(to)
        return Model(model.gear, tuple(effects))

    return Declared("-", sd, lambda model: model.effects[number].height, moved, low, high)


def predicting(monkeypatch, formula) -> None:
    """Let the chain be a formula of the two heights; it returns an array (situation, feature)."""
    replace_predict(
        monkeypatch,
        lambda models, situations, layout, **_: np.array([formula(*(e.height for e in m.effects)) for m in models]),
    )


def replace_predict(monkeypatch, predict) -> None:
    """Let this be the chain's prediction, of the model that is fitted and of those beside it."""
    for module in ("fit.map_fit", "data.model"):
        monkeypatch.setattr(f"swgsim.identification.{module}.predict", predict)


@pytest.mark.parametrize("level", [0.12, 0.2, 0.25])
def test_the_derivative_by_the_level_of_clipping_is_the_one_there(level):
    """Its span reaches to 10 mV/V, and what is cut lies within some hundredths of one."""
    model = Model(GEAR, (Clipping(level),))
    ((name, parameter),) = of_effects(model).items()
    J = linearised(model, {name: parameter}, SITUATIONS, LAYOUT)[1][..., 0]
    near = 1e-4
    above, below = predict([parameter.at(model, level + by) for by in (near, -near)], SITUATIONS, LAYOUT)
    expected = (above - below) / (2 * near) * parameter.sd
    assert np.linalg.norm(J - expected) < 0.1 * np.linalg.norm(expected)


def fitted(parameters, measured, *, noise=0.01, **more):
    """Calibrated to one recording of every situation."""
    errors = Covariance(RecordingCovariance.white(np.full(measured.shape, noise**2)), np.zeros((measured.size, 0)))
    of_recording = np.arange(len(SITUATIONS))
    return calibrate(START, parameters, measured, errors, SITUATIONS, of_recording, LAYOUT, **more)


@pytest.fixture
def A() -> np.ndarray:
    """Features per height, an array (situation, feature, 2)."""
    return np.random.default_rng(1).normal(size=(len(SITUATIONS), len(LAYOUT), 2))


def test_a_fit_comes_to_rest_where_every_full_step_goes_almost_twice_as_far_as_it_should(monkeypatch):
    # A curved feature, missed by so much that the curvature of the cost is 1.9 times what the slopes tell of it.
    shape = np.ones((len(SITUATIONS), 1)) * [1.0, 0.0], np.ones((len(SITUATIONS), 1)) * [0.0, 1.0]
    predicting(monkeypatch, lambda x, _: x * shape[0] + 0.9 * x**2 / 2 * shape[1])
    found = fitted({"x": height(0)}, 0.3 * shape[0] - shape[1], noise=0.05)
    assert found.settled
    least = min(np.linspace(-1, 1, 20001), key=lambda x: (x - 0.3) ** 2 + (0.45 * x**2 + 1) ** 2)
    assert found.model.effects[0].height == pytest.approx(least, abs=3e-3)  # slopes are differences


def test_known_parameters_are_recovered(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A @ [x + 0.1 * x**2, np.sin(y)])
    noise = 0.01 * np.random.default_rng(2).standard_normal(A.shape[:2])
    measured = A @ [0.8 + 0.1 * 0.8**2, np.sin(-0.5)] + noise
    found = fitted({"x": height(0, sd=10), "y": height(1)}, measured)
    assert found.settled
    assert [e.height for e in found.model.effects] == pytest.approx([0.8, -0.5], abs=0.01)
    assert found.position == pytest.approx({"x": 0.08, "y": -0.5}, abs=0.01)
    np.testing.assert_allclose(found.predicted, measured, atol=0.1)
    np.testing.assert_allclose(found.J[..., 0], 10 * (1 + 0.2 * 0.8) * A[..., 0], rtol=0.05)


def test_where_the_data_say_nothing_the_prior_holds(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A[..., 0] * x)
    found = fitted({"x": height(0), "y": height(1)}, 0.5 * A[..., 0])
    assert found.position["y"] == 0
    assert found.position["x"] == pytest.approx(0.5, abs=1e-3)


def test_prior_and_data_are_weighed_by_their_precision(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A[..., 0] * x)
    information = float((A[..., 0] ** 2).sum()) / 100.0
    found = fitted({"x": height(0, sd=0.5)}, 3 * A[..., 0], noise=10.0)
    assert found.model.effects[0].height == pytest.approx(3 * information / (information + 4), rel=0.01)


def test_slopes_are_asked_for_downhill_only(monkeypatch, A):
    """A halved step needs a prediction, not one for every parameter."""
    asked = []

    def formula(x, y):
        asked.append((x, y))
        return A[..., 0] * np.arctan(x)

    predicting(monkeypatch, formula)
    target = A[..., 0] * np.arctan(0.3)
    found = fitted({"x": height(0), "y": height(1)}, target, noise=1e-3, position={"x": 3.0})
    costs = [float(((A[..., 0] * np.arctan(x) - target) ** 2).sum()) for x, _ in asked]
    lowest = np.minimum.accumulate(costs)
    downhill = {x for (x, _), cost, least in zip(asked, costs, lowest, strict=True) if cost == least}
    sloped = {x for x, y in asked if y == DIFFERENCE}
    assert found.settled
    assert len(downhill) < len({x for x, y in asked if y == 0})
    assert sloped <= downhill


def test_what_is_missed_by_far_is_fitted_no_closer_than_it_tells(monkeypatch, A):
    """Of a model that misses a hundred times the noise, the last digits of a fit mean nothing."""
    steps = []
    for miss in (0.0, 1.0):
        asked = []
        predicting(monkeypatch, lambda x, y: asked.append(x) or A[..., 0] * (x + 0.3 * x**2))  # noqa: B023
        found = fitted({"x": height(0)}, A[..., 0] + miss * A[..., 1])
        assert found.settled
        assert found.model.effects[0].height == pytest.approx(0.805, abs=0.1)  # x + 0.3 x^2 = 1
        steps.append(len(asked))
    assert steps[1] < steps[0]


@pytest.mark.parametrize("sd", [1.0, 30.0, 1000.0])
def test_a_step_uphill_is_halved(monkeypatch, A, sd):
    """Newton's steps on the arc tangent swing ever further out when they begin beyond 1.4."""
    predicting(monkeypatch, lambda x, y: A[..., 0] * np.arctan(x))
    found = fitted({"x": height(0, sd=sd)}, A[..., 0] * np.arctan(0.3), noise=1e-3, position={"x": 3.0 / sd})
    right = found.model.effects[0].height == pytest.approx(0.3, abs=1e-2)
    # Small steps in units of a wide spread are no rest; one so wide that slopes are wrong may have none at all.
    assert right or not found.settled
    assert found.settled or sd > 100


def test_a_curved_valley_is_followed(monkeypatch):
    """Where heights must go together (Rosenbrock), cut steps of Gauss-Newton go ahead as little as up."""
    along, across = np.ones((len(SITUATIONS), 1)) * [1.0, 0.0], np.ones((len(SITUATIONS), 1)) * [0.0, 1.0]
    predicting(monkeypatch, lambda x, y: x * along + 20 * (y - x**2) * across)
    found = fitted({"x": height(0), "y": height(1)}, 1.0 * along, position={"x": -1.0, "y": 1.0})
    assert found.settled
    assert [e.height for e in found.model.effects] == pytest.approx([1.0, 1.0], abs=0.01)


def test_a_shorter_step_is_shorter_where_the_longest_was_cut_or_bounded_too(monkeypatch, A):
    """Else the same place is asked again."""
    asked = []

    def formula(x, y):
        asked.append((x, y))
        return A[..., 0] * np.arctan(x)

    predicting(monkeypatch, formula)
    for low in (-np.inf, -40.0):
        asked.clear()
        fitted({"x": height(0, sd=30, low=low)}, A[..., 0] * np.arctan(0.3), noise=1e-3, position={"x": 2.0})
        assert max(np.unique(asked, axis=0, return_counts=True)[1]) <= 2  # a place, and with its slopes


def test_a_step_to_where_nothing_turns_steadily_is_halved(monkeypatch, A):
    """As one of stiffness and inertia together may be, far from the gear."""
    out = []

    def formula(x: float, y: float) -> np.ndarray:
        if abs(x) > 4:
            out.append(x)
            raise NoSteadyState("it does not hold its speed")
        return A[..., 0] * np.arctan(x)

    predicting(monkeypatch, formula)
    found = fitted({"x": height(0, sd=30)}, A[..., 0] * np.arctan(0.3), noise=1e-3, position={"x": 0.1})
    assert out
    assert found.model.effects[0].height == pytest.approx(0.3, abs=1e-2)


def test_a_parameter_next_to_which_nothing_turns_is_left_where_it_is(monkeypatch, A):
    def formula(x: float, y: float) -> np.ndarray:
        if y:
            raise NoSteadyState("it does not hold its speed")
        return A[..., 0] * x

    predicting(monkeypatch, formula)
    found = fitted({"x": height(0), "y": height(1)}, 0.5 * A[..., 0], noise=1e-3)
    assert [effect.height for effect in found.model.effects] == pytest.approx([0.5, 0.0], abs=1e-3)
    assert not found.J[..., 1].any()


def test_a_model_without_a_steady_state_says_so(monkeypatch, A):
    def formula(x: float, y: float) -> np.ndarray:
        raise NoSteadyState("it does not hold its speed")

    predicting(monkeypatch, formula)
    with pytest.raises(ValueError, match="does not hold its speed"):
        fitted({"x": height(0)}, A[..., 0], noise=1e-3)


def test_a_fit_that_does_not_come_to_rest_says_so(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A[..., 0] * x)
    found = fitted({"x": height(0, sd=0.01)}, 1.9 * A[..., 0], noise=1e-5)
    assert not found.settled


def test_bounds_are_respected(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A @ [x, y])
    found = fitted({"x": height(0, high=1.0), "y": height(1, low=-0.2)}, A @ [3.0, -1.0])
    assert [e.height for e in found.model.effects] == [1.0, -0.2]
    # At a bound the derivative is taken inwards, it is not zero.
    np.testing.assert_allclose(found.J, A, rtol=1e-6)


def test_beside_a_bound_the_others_are_at_their_best(monkeypatch, A):
    """What is left at the bound is taken up by the other parameter as far as it can."""
    A = A + 2 * A[..., :1]
    predicting(monkeypatch, lambda x, y: A @ [x, y])
    measured = A @ [3.0, 0.0]
    found = fitted({"x": height(0, high=1.0), "y": height(1)}, measured)
    left = measured - A[..., 0]
    expected = float((A[..., 1] * left).sum() / (A[..., 1] ** 2).sum())
    assert found.model.effects[1].height == pytest.approx(expected, rel=0.01)


def test_many_bounds_of_parameters_that_matter_quite_differently_take_one_step(monkeypatch):
    """As of a gear that was not commissioned; beside them, its least cost is that of non-negative least squares."""
    many = 40
    rng = generator("many bounds")
    slopes = rng.normal(size=(len(SITUATIONS), len(LAYOUT), many)) * 10 ** rng.uniform(-3, 4, many)
    measured = slopes @ np.maximum(rng.uniform(-1, 1, many), 0) + rng.normal(size=slopes.shape[:2])
    monkeypatch.setattr("test_loop_calibration.START", Model(GEAR, (Bump(0.0),) * many))
    asked = []

    def predict(models, *_, **__):
        asked.append(len(models))
        return np.array([slopes @ [e.height for e in m.effects] for m in models])

    replace_predict(monkeypatch, predict)
    found = fitted({str(i): height(i, low=0.0) for i in range(many)}, measured, noise=1.0)
    there = np.array(list(found.position.values()))
    rows = np.vstack([slopes.reshape(-1, many), np.eye(many)])
    aim = np.concatenate([measured.ravel(), np.zeros(many)])
    _, least = nnls(rows, aim)
    assert np.linalg.norm(rows @ there - aim) == pytest.approx(least, rel=1e-5)
    assert asked == [1, many + 1, 1, many + 1, 1]  # the begin; the second step tells that there is no way further


def test_a_model_without_parameters_is_only_predicted(monkeypatch, A):
    predicting(monkeypatch, lambda x, y: A @ [x, y])
    found = fitted({}, A @ [1.0, 1.0])
    assert found.settled
    assert found.J.shape == (len(SITUATIONS), len(LAYOUT), 0)
    assert not found.predicted.any()


@pytest.mark.parametrize("by", [-1e3, 1e3])
@pytest.mark.parametrize("w0", [2e-5, GEAR.wave_generator.w0])
def test_a_fit_that_goes_far_astray_still_has_a_gear(w0, by):
    gear = replace(GEAR, wave_generator=replace(GEAR.wave_generator, w0=w0))
    parameters = {name: p for name, p in of_unit(gear).items() if not name.startswith("kinematic error")}
    astray = at(Model(gear), parameters, dict.fromkeys(parameters, by)).gear
    assert W0_LIMITS[0] <= astray.wave_generator.w0 <= W0_LIMITS[1]


def test_no_fit_makes_a_parameter_of_the_gear_that_cannot_be():
    """A step that leads far below zero ends at the bound, which is that of a gear that still turns; one far beyond, at
    what is another gear or bench.
    """
    model = Model(GEAR)
    bounded = ("k1", "b0", "b1", "mu", "w0")
    moved = at(model, {name: of_unit(GEAR)[name] for name in bounded}, dict.fromkeys(bounded, -1e3)).gear
    for name in bounded[:4]:
        assert 0 < getattr(moved.transmission, name) < getattr(GEAR.transmission, name)
    assert 0 < moved.wave_generator.w0 < GEAR.wave_generator.w0
    far = ("k1", "b0", "b1", "mu", "J_in", "J_out")
    moved = at(model, {name: of_unit(GEAR)[name] for name in far}, dict.fromkeys(far, 1e3)).gear.transmission
    assert [getattr(moved, name) / getattr(GEAR.transmission, name) for name in far] == pytest.approx(
        [MOST_RATIO] * len(far)
    )


@pytest.mark.parametrize("name", ["b0", "b1", "mu"])
def test_what_a_gear_file_says_is_nothing_cannot_be_fitted_within_a_share_of_it(name):
    gear = replace(GEAR, transmission=replace(GEAR.transmission, **{name: 0.0}))
    with pytest.raises(ValueError, match=f"{name} of the gear is 0 .*must be more than 0.*give an estimate"):
        of_unit(gear)


def test_parts_of_the_kinematic_error_are_called_what_they_are():
    """A sin(order phi + phase) is a sine where its phase is 0."""
    errors = (KinematicError(2, 1e-4, 0.0), KinematicError(4, 1e-4, np.pi / 2))
    model = Model(replace(GEAR, transmission=replace(GEAR.transmission, kinematic_error=errors)))
    found = {name: p.value(model) for name, p in of_unit(model.gear).items() if name.startswith("kinematic error")}
    assert found == pytest.approx({
        "kinematic error 2 sine": 1e-4, "kinematic error 2 cosine": 0.0,
        "kinematic error 4 sine": 0.0, "kinematic error 4 cosine": 1e-4,
    }, abs=1e-12)  # fmt: skip
