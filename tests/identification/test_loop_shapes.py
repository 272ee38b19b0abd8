"""An effect whose shape the recordings hardly tell is as uncertain as all shapes together leave it."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import Bump, drawn, fitted_to, holding

from swgsim.effects.base import Effect
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import shape, size
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.fit import shape_marginal as shapes
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.priors import of_effects
from swgsim.identification.fit.shape_marginal import over_shapes
from swgsim.identification.search.hypotheses import hypotheses

LAYOUT = Layout(("T_in", "s1"))
SHARE, CONSTANT = "settling 1: share", "settling 1: constant"


@dataclass(frozen=True)
class Settling(Effect):
    """An effect that grows towards its size."""

    share: float = size(unit="-", low=0, high=100, typical=1)
    constant: float = shape(20.0, unit="s", low=1, high=101, points=7)


TRUTH = Settling(10.0, 40.0)


def settled(time: np.ndarray, constant: float) -> np.ndarray:
    """The share of it that there is, with its derivative by the time constant."""
    return np.stack([-np.expm1(-time / constant), -time / constant**2 * np.exp(-time / constant)])


@pytest.fixture
def fitted_at(monkeypatch):
    """The effect fitted with some share and time constant, to recordings up to a time of what it truly does."""

    def found(longest: float, noise: float, effect: Settling) -> tuple[Fitted, tuple[np.ndarray, np.ndarray]]:
        rng = np.random.default_rng(1)
        fitted = fitted_to(LAYOUT, rng, open_=2)
        time, law = np.linspace(0, longest, len(fitted.measured)), rng.standard_normal(len(LAYOUT)) / noise

        def predicted(models, situations, layout):
            grown = [
                sum((e.share * settled(time, e.constant)[0] for e in m.effects if isinstance(e, Settling)), 0 * time)
                for m in models
            ]
            return np.stack([np.outer(each, law) for each in grown])

        monkeypatch.setattr(shapes, "predict", predicted)
        model = Model(GEAR, (effect,))
        parameters = of_effects(model)
        grown, slope = settled(time, effect.constant)
        J = np.stack([grown, effect.share * slope], axis=1) * [p.sd for p in parameters.values()]
        calibrated = replace(
            fitted.calibrated, model=model, position=dict.fromkeys(parameters, 0.0), J=J[:, None, :] * law[:, None],
        )  # fmt: skip
        told = replace(fitted, parameters=parameters, calibrated=calibrated)
        truth = np.outer(TRUTH.share * settled(time, TRUTH.constant)[0] - effect.share * grown, law)
        return holding(told, truth.ravel() + drawn(fitted.errors, rng)), (time, law)

    return found


def by_hand(fitted: Fitted, time: np.ndarray, law: np.ndarray) -> tuple[float, float]:
    """Both deviations from a fine grid of shares and time constants."""
    effect, errors = fitted.model.effects[0], fitted.errors.with_columns(fitted.open)
    shares, constants = np.linspace(0, 100, 2001), np.linspace(1, 101, 401)
    here = np.outer(effect.share * settled(time, effect.constant)[0], law).ravel()
    left = errors.whiten(fitted.residual + here)
    seen = errors.whiten(np.stack([np.outer(settled(time, c)[0], law).ravel() for c in constants], axis=1))
    cost = (
        shares[:, None] ** 2 * (seen**2).sum(axis=0)
        - 2 * shares[:, None] * (left @ seen)
        + (shares[:, None] / 100) ** 2
    )
    weight = np.exp(-(cost - cost.min()) / 2)
    weight /= weight.sum()
    return (
        float(np.sqrt((weight.sum(axis=1) * (shares - effect.share) ** 2).sum())),
        float(np.sqrt((weight.sum(axis=0) * (constants - effect.constant) ** 2).sum())),
    )


@pytest.mark.parametrize(
    ("longest", "noise", "effect"),
    [(200.0, 1.0, TRUTH), (20.0, 1.0, Settling(6.0, 20.0)), (5.0, 0.3, Settling(3.0, 10.0))],
    ids=["all of it seen", "the start of it", "hardly that"],
)
def test_size_and_shape_are_as_uncertain_as_all_shapes_leave_them(fitted_at, longest, noise, effect):
    fitted, (time, law) = fitted_at(longest, noise, effect)
    found = over_shapes(fitted, 0)
    assert (found[SHARE], found[CONSTANT]) == pytest.approx(by_hand(fitted, time, law), rel=0.1)


@pytest.mark.parametrize("noise", [0.3, 1e-4])
def test_where_a_shape_is_seen_the_derivatives_tell_the_same(fitted_at, noise):
    fitted, _ = fitted_at(200.0, noise, TRUTH)
    exact = holding(fitted, np.zeros(len(fitted.residual)))
    found, told = over_shapes(exact, 0), exact.deviation
    assert [found[name] for name in (SHARE, CONSTANT)] == pytest.approx([told[n] for n in (SHARE, CONSTANT)], rel=0.05)


def test_neither_other_effects_nor_what_was_set_free_change_that(fitted_at):
    fitted, _ = fitted_at(20.0, 1.0, Settling(6.0, 20.0))
    column = np.random.default_rng(2).standard_normal((len(fitted.residual), 1))
    free = fitted.allowing(1e4 * column)
    before = replace(fitted.model, effects=(Bump(1.0), *fitted.model.effects))
    parameters = of_effects(before)
    J = np.concatenate([np.zeros((*fitted.calibrated.J.shape[:2], 1)), fitted.calibrated.J], axis=-1)
    calibrated = replace(fitted.calibrated, model=before, position=dict.fromkeys(parameters, 0.0), J=J)
    second = replace(free, parameters=parameters, calibrated=calibrated)
    found = over_shapes(holding(second, fitted.residual + 1e3 * column[:, 0]), 1)
    assert list(found) == ["settling 2: share", "settling 2: constant"]
    assert list(found.values()) == pytest.approx(list(over_shapes(free, 0).values()), rel=1e-3)


def test_an_effect_without_such_a_shape_is_left_alone():
    fitted = fitted_to(LAYOUT, np.random.default_rng(1))
    assert over_shapes(replace(fitted, calibrated=replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0),)))), 0) == {}


def test_how_lobes_share_the_load_is_open_in_a_gear_of_another_structure_only() -> None:
    """There is one such shape on the structure of the model, and it is that of the model."""
    kind = LIBRARY["eccentric_wave_generator"]
    model, name = Model(GEAR, (kind(1e-5, 0.3),)), "eccentric wave generator 1: unequal"
    for another, tried in ((False, {1.0}), (True, {0.0, 1.0, 2.0, 3.0})):
        assert {dict(each.inner)["unequal"] for each in hypotheses([kind], another)} == tried
        assert (name in of_effects(model, another)) == another
    (alone,) = hypotheses([kind])
    assert alone.repeats(kind(2e-5, 1.0))
    assert not alone.repeats(kind(2e-5, 1.0, unequal=2.0))
