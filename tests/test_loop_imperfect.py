"""Effects that a gear never seen absorbs in the library's form, and that show by how they differ from it."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from fabricated_trials import FITTED, tried
from loop_fixtures import BUMP, WAVE, Bump, drawn, holding
from test_loop_close import accepted, recorded

from swgsim.blind.altered import Alteration, Altered
from swgsim.chain import simulate_turns
from swgsim.effects import Effect
from swgsim.effects.library import LIBRARY
from swgsim.loop import imperfect
from swgsim.loop.closing import close
from swgsim.loop.evidence import FORM_TOLERANCE, parts, powers
from swgsim.loop.hypotheses import Hypothesis
from swgsim.loop.model import Model
from swgsim.loop.unit import Unit

SECTORS = 40
NAMES = (
    "tilted_wave_generator", "root_tooth_crack", "coning", "bridge_nonlinearity", "zero_offset", "channel_skew",
    "gauge_gain", "warm_grease",
)  # fmt: skip
KINDS = [LIBRARY[name] for name in NAMES]
TILTED, CRACKED = LIBRARY["tilted_wave_generator"](1e-3, 1.0), LIBRARY["root_tooth_crack"](0.4, 1.0)
ANOTHER_LAW, SCATTERED = Alteration(exponent=0.2), Alteration(spread=0.1, speed=3e-3, load=0.1, phase=1.0)


@pytest.fixture
def _coarse_mesh() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "swgsim.loop.model.simulate_turns",
            lambda runs, revolutions, points, sectors: simulate_turns(runs, revolutions, points, SECTORS),
        )
        yield


@pytest.mark.end_to_end
@pytest.mark.usefixtures("_coarse_mesh")
@pytest.mark.parametrize(
    ("effect", "alteration", "size"),
    [(TILTED, ANOTHER_LAW, "tilt"), (TILTED, SCATTERED, "tilt"), (CRACKED, ANOTHER_LAW, "stiffness_ratio")],
)
def test_an_effect_that_the_gear_absorbs_is_found_by_how_it_differs_from_the_library(effect, alteration, size):
    measured, unit = recorded((Altered(effect, alteration),), 3), Unit(Model(GEAR))
    closed = close(measured, unit, KINDS)
    (found,) = accepted(closed)
    assert closed.steps[0].accepted.imperfect
    assert not closed.unknown
    assert type(found) is type(effect)
    assert getattr(found, size) == pytest.approx(getattr(effect, size), rel=0.15)
    assert found.theta == pytest.approx(effect.theta, abs=0.1)
    if effect is CRACKED:
        others = [kind for kind in KINDS if kind is not type(effect)]
        without = close(measured, unit, others)
        assert not without.steps
        assert without.unknown


def typical(hypothesis: Hypothesis, rng: np.random.Generator) -> np.ndarray:
    """A signature of every column, as large as the noise."""
    return rng.standard_normal((len(FITTED.residual), len(hypothesis.columns)))


@pytest.mark.parametrize("hypothesis", [BUMP, WAVE])
def test_a_hypothesis_is_as_likely_as_its_covariance_makes_the_residual(hypothesis):
    rng = np.random.default_rng(4)
    signature = typical(hypothesis, rng)
    fitted = holding(FITTED, drawn(FITTED.whole, rng) + 2 * signature @ np.ones(signature.shape[1]))
    r = fitted.whole.whiten(fitted.from_start)
    loose = imperfect._loose(fitted, hypothesis, signature, r)
    assert 0.5 < loose.times < 5
    open_ = [signature]
    for column in signature.T:
        open_ += [FORM_TOLERANCE * parts(fitted, column), FORM_TOLERANCE * powers(fitted, column)]
    gained = [
        fitted.whole.with_columns(times * np.hstack(open_)).log_likelihood(fitted.from_start) - fitted.log_likelihood
        for times in (loose.times, 1.5 * loose.times)
    ]
    assert loose.evidence == pytest.approx(gained[0], rel=1e-6)
    assert gained[1] < gained[0]


def test_an_effect_is_as_likely_as_what_it_leaves_beside_its_open_form(monkeypatch):
    rng = np.random.default_rng(5)
    signature = typical(BUMP, rng)
    monkeypatch.setattr(imperfect, "changes", lambda fitted, effects: signature * [[e.height for e in effects]])
    fitted = holding(FITTED, drawn(FITTED.whole, rng) + 5 * signature[:, 0])
    sizes = (4.0, 5.0, 6.0)
    found = imperfect._log_likelihoods(fitted, [Bump(height) for height in sizes])
    expected = []
    for height in sizes:
        change = height * signature[:, 0]
        whole = fitted.whole.with_columns(FORM_TOLERANCE * np.hstack([parts(fitted, change), powers(fitted, change)]))
        expected.append(whole.log_likelihood(fitted.from_start - change))
    np.testing.assert_allclose(np.diff(found), np.diff(expected), rtol=1e-6)


@pytest.mark.parametrize(("kept", "none"), [(0.9, False), (3.0, False), (0.4, True), (-1.0, True)])
def test_what_explains_only_by_its_imperfections_is_none(monkeypatch, kept, none):
    def fit(now, score, added: tuple[Effect, ...], start):
        return replace(trial, effects=(Bump(kept * added[0].height),))

    trial = tried(BUMP)
    monkeypatch.setattr(imperfect, "_zoomed", lambda *_: Bump(2.0))
    monkeypatch.setattr(imperfect, "changes", lambda fitted, effects: np.ones((len(FITTED.residual), 1)))
    monkeypatch.setattr(imperfect, "tried", fit)
    found = imperfect._tried(FITTED, FITTED, trial.score, imperfect.Loose(BUMP, 10.0, 1.0))
    assert found is None if none else found.imperfect
