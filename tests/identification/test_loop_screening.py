"""The score test is right about chance, size and what cannot be seen."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from loop_fixtures import BUMP, WAVE, drawn, fitted_to, holding
from scipy.stats import binom, kstest

from swgsim.effects import Effect
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import size
from swgsim.identification.data.features import Layout
from swgsim.identification.report.open_questions import detectable
from swgsim.identification.search.hypotheses import Hypothesis, hypotheses
from swgsim.identification.search.screening import Score, best_of_kind, screen


@dataclass(frozen=True)
class Growth(Effect):
    """An effect that there cannot be less of than nothing."""

    height: float = size(unit="-", low=0, high=100, typical=2)


LAYOUT = Layout(("s0",))
TYPICAL = 2.0


@pytest.fixture
def fitted():
    """A model of six recordings with little noise in some features and much in others."""
    return fitted_to(LAYOUT, np.random.default_rng(1))


def found_for(fitted, residual, signatures, hypotheses=None, seed=1) -> list[Score]:
    """Scores of bumps, or of waves where a signature has two columns."""
    hypotheses = hypotheses or [BUMP if s.shape[1] == 1 else WAVE for s in signatures]
    return screen(hypotheses, signatures, holding(fitted, residual), np.random.default_rng(seed))


def library(fitted, columns=1, seed=2) -> list[np.ndarray]:
    """Signatures of 20 effects, some alike, some all but within the open directions."""
    rng = np.random.default_rng(seed)
    shape = (len(fitted.errors.variance), columns)
    first = rng.standard_normal(shape)
    alike = [first + 0.2 * rng.standard_normal(shape) for _ in range(5)]
    hidden = [fitted.open[:, :columns] + 0.3 * rng.standard_normal(shape) for _ in range(5)]
    return [*alike, *hidden, *(rng.standard_normal(shape) for _ in range(10))]


@pytest.mark.parametrize("columns", [1, 2])
def test_chance_of_the_whole_library_is_uniform_if_nothing_is_missing(fitted, columns):
    rng, draws = np.random.default_rng(3), 120
    signatures = library(fitted, columns)
    found = [
        min(s.chance for s in found_for(fitted, drawn(fitted.whole, rng), signatures, seed=i)) for i in range(draws)
    ]
    assert kstest(found, "uniform").pvalue > 0.001
    for level in (0.05, 0.2):
        low, high = binom.interval(0.999, draws, level)
        assert low <= (np.array(found) <= level).sum() <= high


def test_far_out_the_chance_is_bonferronis(fitted):
    signatures = library(fitted, columns=2)
    scores = found_for(fitted, 3 * signatures[-1][:, 0], signatures)
    best = scores[0]
    assert 0 < best.chance < 1e-20
    assert best.chance == pytest.approx(len(signatures) * np.exp(-best.gain / 2), rel=0.01)
    assert scores == sorted(scores, key=lambda s: -s.rank)


def test_what_declared_parameters_absorb_is_never_claimed(fitted):
    rng = np.random.default_rng(4)
    wide = replace(fitted, open=1e4 * fitted.open)
    absorbed = fitted.open @ rng.standard_normal((4, 1))
    for seed in range(20):
        residual = 100 * absorbed[:, 0] + drawn(fitted.errors, rng)
        (score,) = found_for(wide, residual, [absorbed], seed=seed)
        assert score.absorbed
        assert (score.gain, score.freedom, score.chance, score.deviation) == (0.0, 0, 1.0, np.inf)


def test_what_lies_far_beyond_the_spread_of_a_declared_parameter_stands_out(fitted):
    """However little of it is left beside a spread that is wide against the noise."""
    wide = replace(fitted, open=30 * fitted.open)
    signature = wide.open[:, :1]  # one spread for every typical size
    found = []
    for seed in range(10):
        r = 20 * signature[:, 0] + drawn(fitted.errors, np.random.default_rng(seed))
        (score,) = found_for(wide, r, [signature], seed=seed)
        assert score.visible < 1e-5
        assert not score.absorbed
        assert score.chance < 1e-6
        found.append(score.estimate / TYPICAL)
    np.testing.assert_allclose(found, 20, atol=0.1)


def test_what_declared_parameters_absorb_in_part_counts_for_its_rest(fitted):
    rng = np.random.default_rng(5)
    wide = replace(fitted, open=1e4 * fitted.open)
    rest = rng.standard_normal((len(fitted.errors.variance), 1))
    r = 5 * rest[:, 0] + drawn(wide.whole, rng)
    (plain,) = found_for(wide, r, [rest])
    (mixed,) = found_for(wide, r, [rest + fitted.open @ rng.standard_normal((4, 1))])
    assert mixed.gain == pytest.approx(plain.gain, rel=1e-3)
    assert mixed.estimate == pytest.approx(plain.estimate, rel=1e-3)
    assert mixed.visible < plain.visible


@pytest.mark.parametrize("true", [0.0, 1.0, -6.0])
def test_size_is_right_within_its_stated_deviation(fitted, true):
    rng = np.random.default_rng(6)
    signature = fitted.open[:, :1] + 0.3 * rng.standard_normal((len(fitted.errors.variance), 1))
    missed = []
    for seed in range(150):
        r = true / TYPICAL * signature[:, 0] + drawn(fitted.whole, rng)
        (score,) = found_for(fitted, r, [signature], seed=seed)
        missed.append((score.estimate - true) / score.deviation)
    assert 0.90 <= np.mean(np.abs(missed) < 1.96) <= 0.98
    assert np.mean(missed) == pytest.approx(0, abs=4 / np.sqrt(150))


@pytest.mark.parametrize("second", [1.0, 0.2])
def test_size_and_phase_of_a_wave(fitted, second):
    """Also when the cosine part is seen much better than the sine part."""
    rng = np.random.default_rng(7)
    signature = rng.standard_normal((len(fitted.errors.variance), 2)) * [1.0, second]
    missed, turned = [], []
    for seed in range(200):
        theta = rng.uniform(0, 2 * np.pi)
        r = 8 / TYPICAL * signature @ [np.cos(theta), np.sin(theta)] + drawn(fitted.whole, rng)
        (score,) = found_for(fitted, r, [signature], seed=seed)
        missed.append((score.estimate - 8) / score.deviation)
        turned.append(np.angle(np.exp(1j * (score.phase - theta))))
    assert np.abs(np.mean(turned)) < 0.1
    assert 0.90 <= np.mean(np.abs(missed) < 1.96) <= 0.98


def test_size_stays_within_the_bounds_of_the_effect(fitted):
    signature = library(fitted)[-1]
    (score,) = found_for(fitted, 1e4 * signature[:, 0], [signature])
    assert score.estimate == 100


@pytest.mark.parametrize("columns", [1, 2])
def test_noise_gains_one_per_number_fitted(fitted, columns):
    rng = np.random.default_rng(8)
    signatures = library(fitted, columns)
    gains = [sum(s.gain for s in found_for(fitted, drawn(fitted.whole, rng), signatures, seed=i)) for i in range(40)]
    assert np.mean(gains) == pytest.approx(sum(s.shape[1] for s in signatures), rel=0.2)


def test_an_effect_that_is_tried_more_often_ranks_lower(fitted):
    signature = library(fitted)[-1]
    often, once = Hypothesis(BUMP.kind, (), 100), BUMP
    scores = found_for(fitted, signature[:, 0], [signature, signature], [often, once])
    assert [s.hypothesis for s in scores] == [once, often]
    assert scores[0].rank - scores[1].rank == pytest.approx(2 * np.log(100))
    assert best_of_kind(scores) == scores[:1]


def test_one_effect_of_twenty_is_seen_at_the_size_that_is_called_detectable(fitted):
    """Four of five times at the level of one in a hundred."""
    rng = np.random.default_rng(9)
    signatures = library(fitted)
    alone = {s.deviation for s in found_for(fitted, drawn(fitted.whole, rng), signatures[-1:])}
    size = 5.0 * alone.pop()
    seen = []
    for seed in range(40):
        r = size / TYPICAL * signatures[-1][:, 0] + drawn(fitted.whole, rng)
        seen.append(min(s.chance for s in found_for(fitted, r, signatures, seed=seed)) <= 0.01)
    assert np.mean(seen) >= 0.7


def test_an_effect_of_less_than_nothing_is_none(fitted):
    """It ranks behind all others, but it can be tested: it is not absorbed."""
    one_sided = Hypothesis(Growth, (), 1)
    signatures = library(fitted)
    kinds = [one_sided if number == 0 else BUMP for number in range(len(signatures))]
    score = next(s for s in found_for(fitted, -5 * signatures[0][:, 0], signatures, kinds) if s.hypothesis is one_sided)
    assert (score.gain, score.chance) == (0, 1)
    assert np.isfinite(score.detectable)
    assert not score.absorbed


def test_no_size_beyond_its_bounds_is_called_the_smallest_that_is_seen():
    clear = Score(Hypothesis(Growth, (), 1), 0.0, 1, 0.0, 0.0, 1.0, 0.5, 1.0)
    assert detectable(clear)["value"] == pytest.approx(clear.detectable)
    blurred = replace(clear, deviation=100.0)
    assert detectable(blurred)["value"] is None
    assert not detectable(blurred)["typical_would_be_seen"]


@pytest.mark.parametrize(
    ("name", "chosen", "left"),
    [
        ("thermal_growth", {}, 0),  # two of them are one of another size
        ("gauge_gain", {"sensor": 2}, 5),
        ("kinematic_error_order", {"order": 2}, None),  # a wave: of any phase
        ("self_heating", {}, 7),  # with another time constant
        ("root_tooth_crack", {"theta": 0.0}, 24),  # at another place
    ],
)
def test_what_is_in_the_model_is_not_asked_again(name, chosen, left):
    kind = LIBRARY[name]
    found = list(hypotheses([kind]))
    there = replace(found[0].effect(), **chosen)
    rest = [each for each in found if not each.repeats(there)]
    assert len(rest) == (len(found) - 1 if left is None else left)
    assert not any(each.repeats(LIBRARY["seal_friction"](0.1)) for each in found)
