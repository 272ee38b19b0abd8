"""Effects that a gear never seen absorbs in the library's form, and that show by how they differ from it."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from fabricated_trials import FITTED, A
from loop_fixtures import BUMP, WAVE, Bump, Wave, drawn, holding
from swgsim.identification.decide.stepwise_selection import close
from test_loop_close import _coarse_mesh, recorded  # noqa: F401

from swgsim.blind.altered import Alteration, Altered
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import quantities
from swgsim.effects.regularity import Regularity
from swgsim.identification.data.model import Model
from swgsim.identification.decide import form_error_evidence as imperfect
from swgsim.identification.fit.form_error import FORM_TOLERANCE, parts, powers
from swgsim.identification.fit.unit import Unit
from swgsim.identification.search.hypotheses import Hypothesis

pytestmark = pytest.mark.slow

# With what looks like a tilt and like a crack.
NAMES = (
    "tilted_wave_generator", "root_tooth_crack", "eccentric_wave_generator", "out_of_round", "coning", "gauge_gain",
    "bridge_nonlinearity", "zero_offset", "channel_skew", "warm_grease",
)  # fmt: skip
KINDS = [LIBRARY[name] for name in NAMES]
TILTED, CRACKED = LIBRARY["tilted_wave_generator"](1e-3, 1.0), LIBRARY["root_tooth_crack"](0.25, 1.0)
ANOTHER_LAW, SCATTERED = Alteration(exponent=0.2), Alteration(spread=0.1, speed=3e-3, load=0.1, phase=1.0)
UNIT, ONCE_MORE = Unit(Model(GEAR)), replace(FITTED)


@pytest.mark.end_to_end
@pytest.mark.parametrize(
    ("effect", "alteration", "size"),
    [(TILTED, SCATTERED, "tilt"), (CRACKED, ANOTHER_LAW, "stiffness_ratio")],
)
def test_an_effect_that_the_gear_absorbs_is_found_by_how_it_differs_from_the_library(effect, alteration, size):
    measured = recorded((Altered(effect, alteration),), 3)
    closed = close(measured, UNIT, KINDS)
    (step,) = closed.steps
    assert step.accepted.imperfect
    assert not closed.unknown
    told = {type(each): each for trial in (*step.rivals, step.accepted) for each in trial.effects}
    assert getattr(told[type(effect)], size) == pytest.approx(getattr(effect, size), rel=0.3)
    if effect is CRACKED:
        assert told[type(effect)].theta == pytest.approx(effect.theta, abs=0.1)
        without = close(measured, UNIT, [kind for kind in KINDS if kind is not type(effect)])
        assert not without.steps
        assert without.unknown


@pytest.mark.end_to_end
def test_a_bare_regularity_gets_no_name():
    plain = Regularity(3, 2e-2, 1.0, "opposite in s1 and s3", "proportional to the load")
    closed = close(recorded((plain,), 3), UNIT, [*KINDS, LIBRARY["mains_hum"]])
    assert not closed.steps
    assert closed.unknown[0].atom.order == 3


@pytest.mark.parametrize("times", [0.5, 10.0])
def test_moves_keep_to_the_bounds(times):
    kind = LIBRARY["reduced_stiffness"]
    hypothesis = Hypothesis(kind, (), 1)
    sizes = [
        e.k1_ratio for e in imperfect._anywhere(imperfect.Opened(replace(A.score, hypothesis=hypothesis), 1.0, times))
    ]
    assert len(sizes) == len(set(sizes)) > 0
    for size in sizes:
        moved = [each.k1_ratio for each in imperfect._around(kind(size), 0.5, another_structure=False)]
        declared = quantities(kind)["k1_ratio"]
        assert all(declared.low <= each <= declared.high for each in moved)
        assert declared.nothing not in sizes
    turned = [each.theta for each in imperfect._around(Wave(1.0, 0.1), 0.5, another_structure=False)]
    assert all(0 <= theta < 2 * np.pi for theta in turned)


def typical(hypothesis: Hypothesis, rng: np.random.Generator) -> np.ndarray:
    """A signature of every column, as large as the noise."""
    return rng.standard_normal((len(FITTED.residual), len(hypothesis.columns)))


@pytest.mark.parametrize("hypothesis", [BUMP, WAVE])
def test_a_hypothesis_is_as_likely_as_its_covariance_makes_the_residual(hypothesis):
    rng = np.random.default_rng(4)
    signature = typical(hypothesis, rng)
    fitted = holding(FITTED, drawn(FITTED.whole, rng) + 2 * signature @ np.ones(signature.shape[1]))
    r = fitted.whole.whiten(fitted.from_start)
    opened = imperfect._opened(fitted, replace(A.score, hypothesis=hypothesis), signature, r)
    assert 0.5 < opened.times < 5
    open_ = [signature]
    for column in signature.T:
        open_ += [FORM_TOLERANCE * parts(fitted, column), FORM_TOLERANCE * powers(fitted, column)]
    gained = [
        fitted.whole.with_columns(times * np.hstack(open_)).log_likelihood(fitted.from_start) - fitted.log_likelihood
        for times in (opened.times, 1.5 * opened.times)
    ]
    assert opened.evidence == pytest.approx(gained[0], rel=1e-6)
    assert gained[1] < gained[0]


def test_an_effect_is_as_likely_as_what_it_leaves_beside_its_open_form(monkeypatch):
    rng = np.random.default_rng(5)
    signature = typical(BUMP, rng)
    monkeypatch.setattr(
        imperfect,
        "changes",
        lambda fitted, effects: np.where(
            [e.height < 9 for e in effects], signature * [[e.height for e in effects]], np.nan
        ),
    )
    fitted = holding(FITTED, drawn(FITTED.whole, rng) + 5 * signature[:, 0])
    sizes = (4.0, 5.0, 6.0)
    *found, none = imperfect._log_likelihoods(fitted, [Bump(height) for height in (*sizes, 9.0)])
    assert none == -np.inf
    expected = []
    for height in sizes:
        change = height * signature[:, 0]
        whole = fitted.whole.with_columns(FORM_TOLERANCE * np.hstack([parts(fitted, change), powers(fitted, change)]))
        expected.append(whole.log_likelihood(fitted.from_start - change))
    np.testing.assert_allclose(np.diff(found), np.diff(expected), rtol=1e-6)
