"""The decision by evidence, with fabricated Gaussian numbers: evidence, prior, search, probabilities and words."""

from dataclasses import replace
from itertools import combinations, product
from math import comb

import numpy as np
import pytest
from linear_chain import KINDS, Bump, Dip, Mimic, Step, patch_chain, signatures_of
from loop_fixtures import drawn, fitted_to, holding
from scipy.special import logsumexp
from scipy.stats import binom, multivariate_normal, norm

from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.effects.quantity import Quantity, Role
from swgsim.effects.regularity import LAWS, PATTERNS
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.identification.decide.decision import CREDIBLE, decide
from swgsim.identification.decide.evidence import ZEROS, expected_gain
from swgsim.identification.decide.option import causes_of, option, resembling
from swgsim.identification.decide.prior import (
    BALANCED,
    FORM_ERRORS,
    LOG_SIZE_RANGE,
    MOST_CAUSES,
    OTHER_FORMS,
    TIMES_BALANCED,
    log_prior,
    prior_ratio,
    ratio_of_parameter,
    uniform_weights,
)
from swgsim.identification.decide.search import Search
from swgsim.identification.fit.form_error import all_show, form_directions, parts
from swgsim.identification.report.answer import Answer
from swgsim.identification.report.found_effects import alternatives, found_effects, options, probability_text, small
from swgsim.identification.report.sentence import sentence
from swgsim.identification.search.regularities import Atom, columns, describe

LAYOUT = Layout(("T_in", "s1"))
STRAY = Atom(5, "in s1 alone", "constant")


@pytest.fixture(scope="module")
def null():
    """Six operating points, noise of about 1, and errors of the session such as zeros of gauges."""
    fitted = fitted_to(LAYOUT, np.random.default_rng(1), open_=2)
    errors = Covariance(fitted.errors.alone, fitted.measured.session_columns(fitted.calibrated.predicted))
    return replace(fitted, errors=errors)


@pytest.fixture(scope="module")
def changes(null):
    return signatures_of(null, np.random.default_rng(2))


@pytest.fixture
def _chain(null, changes, monkeypatch):
    patch_chain(monkeypatch, null, changes)


def recorded(null, changes, hidden, seed, more=0.0):
    """The null model, held against recordings with effects."""
    signal = sum((size * changes[kind].ravel() for kind, size in hidden.items()), start=0.0 + more)
    return holding(null, signal + drawn(null.whole, np.random.default_rng(seed)))


def density(fitted, residual, *more):
    """Log density of a residual by the covariance written out, up to the constant of the loop."""
    blocks = [fitted.errors.columns, fitted.open, fitted.allowed.columns, *more]
    every = np.hstack(blocks)
    covariance = np.diag(fitted.errors.variance) + every @ every.T
    return multivariate_normal(cov=covariance).logpdf(residual) + len(residual) / 2 * np.log(2 * np.pi)


def ratio_of(fitted, number):
    """Of the priors of an added effect, as the fit left it."""
    return prior_ratio(fitted, fitted.numbers_added[number], fitted.deviation, fitted.calibrated.position)


@pytest.mark.usefixtures("_chain")
def test_evidence_is_the_marginal_likelihood(null):
    """Of bridges as they were, and balanced anew: zeros so many times as far off."""
    held = holding(null, drawn(null.whole, np.random.default_rng(3)))
    found = option(held, (), (), len(KINDS))
    assert found.form_error == 0
    for times, each in zip(ZEROS, logsumexp(found.evidences, axis=1), strict=True):
        anew = replace(null.measured, zeros=times).session_columns(held.calibrated.predicted)
        wider = replace(held, errors=Covariance(held.errors.alone, anew))
        prior = 1 - BALANCED if times == 1 else BALANCED / len(TIMES_BALANCED)
        assert each == pytest.approx(np.log(prior) + density(wider, held.residual), abs=1e-6)
    assert found.log_evidence == pytest.approx(logsumexp(found.evidences))


@pytest.mark.usefixtures("_chain")
def test_zeros_of_bridges_balanced_anew_are_seen_and_are_no_effect(null, changes):
    """As far off as 10 times what they move from session to session."""
    mean = np.tile((LAYOUT.channel == "s1") & (LAYOUT.order == 0), len(null.measured)).astype(float)
    sharp = replace(
        null,
        measured=replace(null.measured, variance=1e-8 * null.measured.variance),
        errors=Covariance(RecordingCovariance.white(1e-8 * null.measured.variance), null.errors.G),
        open=null.open[:, :0],
    )
    noise = 1e-4 * np.random.default_rng(4).standard_normal(len(mean))
    calm, anew = (option(holding(sharp, noise + off * mean), (), (), len(KINDS)) for off in (0.003, 0.05))
    assert calm.zeros == 1
    assert anew.zeros in (8.0, 16.0)


@pytest.mark.usefixtures("_chain")
def test_evidence_of_an_effect_is_the_mean_over_the_form_errors(null, changes):
    held = recorded(null, changes, {Bump: 5.0}, 5)
    found = option(held, (Bump(4.0),), (), len(KINDS))
    fitted, (D,) = found.fitted, form_directions(found.fitted)
    by_error = [density(fitted, fitted.from_start, fitted.J, each * D) for each in FORM_ERRORS]
    expected = np.log(1 - BALANCED) + logsumexp(by_error) - np.log(len(FORM_ERRORS)) + ratio_of(fitted, 0)
    assert found.zeros == 1
    assert logsumexp(found.evidences[0]) == pytest.approx(expected, abs=1e-4)
    weights = np.exp(by_error - logsumexp(by_error))
    assert found.form_error**2 == pytest.approx(weights @ np.square(FORM_ERRORS), rel=1e-3)


@pytest.mark.usefixtures("_chain")
def test_evidence_of_what_resembles_an_effect_is_the_mean_over_all_form_errors(null, changes):
    """Beside another effect, whose form error is one of those of effects."""
    found = option(recorded(null, changes, {Bump: 5.0, Dip: 2.0}, 5), (Bump(4.0), Dip(1.0)), (), len(KINDS))
    of_bump, of_dip, of_both = resembling(found, len(KINDS))
    assert [[type(e) for e in each.effects] for each in (of_bump, of_dip, of_both)] == [[Dip], [Bump], []]
    assert [type(e) for e in of_dip.resembled] == [Dip]
    fitted = found.fitted
    B, D = form_directions(fitted)
    unlike = zip(OTHER_FORMS, uniform_weights(OTHER_FORMS), strict=True)
    by_error = [
        density(fitted, fitted.from_start, fitted.J, known * B, other * D) + np.log(probability / len(FORM_ERRORS))
        for known, (other, probability) in product(FORM_ERRORS, unlike)
    ]
    expected = np.log(1 - BALANCED) + logsumexp(by_error) + ratio_of(fitted, 0) + ratio_of(fitted, 1)
    assert logsumexp(of_dip.evidences[0]) == pytest.approx(expected, abs=1e-4)
    assert of_both.log_prior - found.log_prior == pytest.approx(log_prior(0, 2, 0, 4) - log_prior(2, 0, 0, 4))


@pytest.mark.usefixtures("_chain")
def test_evidence_of_what_resembles_one_effect_is_that_of_all_shares_from_nothing_to_all_of_it(null, changes):
    found = option(recorded(null, changes, {Bump: 5.0}, 5), (Bump(4.0),), (), len(KINDS))
    (of_bump,), fitted, (D,) = resembling(found, len(KINDS)), found.fitted, form_directions(found.fitted)
    by_error = [density(fitted, fitted.from_start, fitted.J, each * D) for each in OTHER_FORMS]
    expected = np.log(1 - BALANCED) + logsumexp(by_error + np.log(uniform_weights(OTHER_FORMS))) + ratio_of(fitted, 0)
    assert logsumexp(of_bump.evidences[0]) == pytest.approx(expected, abs=1e-4)


@pytest.mark.usefixtures("_chain")
def test_an_unknown_cause_with_the_lines_of_an_effect_is_called_unknown(null, changes):
    """Half of the lines of a bump the wrong way round: no bump, and too many lines for a few regularities."""
    sign = np.where(np.arange(len(null.residual)) % 2, -1.0, 1.0)
    found, said = answered(null, changes, {}, 17, 20 * sign * changes[Bump].ravel())
    assert found.verdict == UNKNOWN
    assert found.decision.best.regularities
    assert "not in the library" in said
    found, _ = answered(null, changes, {Bump: 20.0}, 17)
    assert found.verdict == FOUND


@pytest.mark.usefixtures("_chain")
def test_no_effect_is_surer_than_unknown_causes_that_look_just_like_it_are_rare(null, changes):
    found, _ = answered(null, changes, {Bump: 0.5}, 18)
    alike = len(FORM_ERRORS) * uniform_weights(OTHER_FORMS).min()
    odds = alike * np.exp(log_prior(0, 1, 0, len(KINDS)) - log_prior(1, 0, 0, len(KINDS)))
    assert found.decision.probability < 1 / (1 + odds)
    assert found.decision.probability > 0.9


@pytest.mark.usefixtures("_chain")
def test_an_effect_that_changes_nothing_explains_nothing(null, changes):
    """As clipping above all signals: fits get stuck there, as its level has no slope."""
    found = option(recorded(null, changes, {Bump: 5.0}, 5), (Bump(4.0),), (), len(KINDS)).fitted
    assert all_show(found)
    gone = replace(found.calibrated, model=found.unit.model.plus(*found.added, Bump(0.0)))
    assert not all_show(replace(found, calibrated=gone))


@pytest.mark.usefixtures("_chain")
@pytest.mark.parametrize("begin", [1.0, 40.0])
def test_a_size_is_integrated_over_its_logarithm_wherever_the_fit_began(null, changes, begin):
    """Numerically: a size is positive or negative, and its logarithm is uniform."""
    held = recorded(null, changes, {Bump: 5.0}, 6)
    found = option(held, (Bump(begin),), (), len(KINDS))
    (D,) = form_directions(found.fitted)
    (effect,), column = found.effects, changes[Bump].ravel()
    sizes = np.linspace(0.7, 1.3, 121) * effect.height
    likely = []
    for error in FORM_ERRORS:
        every = np.hstack([held.errors.columns, held.open, error * D])
        normal = multivariate_normal(cov=np.diag(held.errors.variance) + every @ every.T)
        likely.append(normal.logpdf(held.residual - sizes[:, None] * column) + len(column) / 2 * np.log(2 * np.pi))
    densities = np.exp(logsumexp(likely, axis=0) - np.log(len(FORM_ERRORS)) - logsumexp(found.evidences[0]))
    integral = np.trapezoid(densities / (2 * LOG_SIZE_RANGE * np.abs(sizes)), sizes)
    expected = np.log(1 - BALANCED) + np.log(integral) + logsumexp(found.evidences[0]) + log_prior(1, 0, 0, len(KINDS))
    assert found.log_prior + logsumexp(found.evidences[0]) == pytest.approx(expected, abs=0.05)


@pytest.mark.usefixtures("_chain")
def test_an_amplitude_of_a_regularity_is_integrated_over_its_logarithm_and_all_phases(null):
    """Numerically, of a wave that the recordings tell well."""
    C = columns(STRAY, null)
    held = holding(null, drawn(null.whole, np.random.default_rng(8)) + C @ [30.0, -40.0])
    stray = next(each for each in describe(held) if each.atom == STRAY)
    found = option(held, (), (stray,), len(KINDS))
    turn = np.linspace(-0.3, 0.3, 61)
    sizes, phases = np.meshgrid(stray.amplitude * np.exp(turn), stray.phase + turn)
    x, r = held.whole.whiten(C), held.white
    waves = np.stack([sizes * np.cos(phases), -sizes * np.sin(phases)], axis=-1)
    gained = waves @ (x.T @ r) - np.einsum("...i,ij,...j", waves, x.T @ x, waves) / 2
    likely = np.trapezoid(np.trapezoid(np.exp(gained - gained.max()), turn), turn) / (2 * np.pi * LOG_SIZE_RANGE)
    expected = held.log_likelihood + np.log(1 - BALANCED) + gained.max() + np.log(likely)
    assert logsumexp(found.evidences[0]) == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize("width", [0.01, 0.05, np.inf])
def test_a_shape_is_integrated_over_its_range_wherever_the_fit_began(width):
    """Numerically, with a normal likelihood of this width; infinite: the recordings do not tell the shape."""
    q, sd, began, peak = Quantity(Role.SHAPE, "-", 0.0, 2.0, 1.0), 0.1, 1.0, 1.02
    grid = np.linspace(0, 2, 40001)
    likelihood = np.exp(-((grid - peak) ** 2) / (2 * width**2))
    of_fit = np.trapezoid(likelihood * norm.pdf(grid, began, sd), grid)
    expected = np.trapezoid(likelihood / (q.high - q.low), grid)
    deviation = 1 / np.sqrt(width**-2 + sd**-2)
    value = began + (peak - began) * (deviation / width) ** 2
    ratio = ratio_of_parameter(q, value, deviation, sd, (value - began) / sd)
    assert np.log(of_fit) + ratio == pytest.approx(np.log(expected), abs=0.05)


@pytest.mark.usefixtures("_chain")
def test_expected_evidence_is_near_that_of_the_fit(null, changes):
    held = recorded(null, changes, {Bump: 3.0}, 7)
    without, found = option(held, (), (), 4), option(held, (Bump(3.0),), (), 4)
    (effect,) = found.effects
    gained = found.log_posterior - without.log_posterior - log_prior(1, 0, 0, 4) + log_prior(0, 0, 0, 4)
    assert gained > 50
    assert expected_gain(held, effect.height * changes[Bump].ravel()) == pytest.approx(gained, rel=0.05)
    assert parts(held, changes[Bump].ravel()).shape[1] == 6 + 2 + ORDERS + 1


@pytest.mark.parametrize("kinds", [2, 10, 60])
def test_priors_of_all_options_sum_to_at_most_one(kinds):
    total, atoms = 0.0, (ORDERS + 1) * len(PATTERNS) * len(LAWS)
    for effects in range(min(kinds, MOST_CAUSES) + 1):
        sets = comb(kinds, effects)
        total += sets * np.exp(log_prior(effects, 0, 0, kinds))
        for resembled in range(1, effects + 1):
            split = comb(effects, resembled) * sets
            total += split * np.exp(log_prior(effects - resembled, resembled, 0, kinds))
        for regularities in range(1, 30):
            total += sets * comb(atoms, regularities) * np.exp(log_prior(effects, 0, regularities, kinds))
    assert 0.85 < total <= 1 + 1e-9


def test_more_causes_are_less_probable():
    assert [log_prior(n, 0, 0, 60) for n in range(4)] == sorted(
        (log_prior(n, 0, 0, 60) for n in range(4)), reverse=True
    )
    regular = [log_prior(0, 0, n, 60) for n in range(4)]
    assert regular == sorted(regular, reverse=True)
    assert log_prior(1, 0, 0, 60) > log_prior(0, 1, 0, 60) > log_prior(0, 0, 1, 60)  # a regularity is one of thousands
    assert log_prior(1, 0, 0, 30) > log_prior(1, 0, 0, 60)
    assert log_prior(MOST_CAUSES + 1, 0, 0, 60) == log_prior(MOST_CAUSES, 0, 1, 60) == -np.inf


@pytest.mark.usefixtures("_chain")
@pytest.mark.parametrize(
    "hidden",
    [{}, {Bump: 2.0}, {Mimic: 1.0}, {Bump: 0.15}, {Dip: 1.0, Step: -0.4}, {Bump: 3.0, Mimic: -2.0}, {
        Bump: 1.0, Dip: 0.3, Step: 2.0
    }],
    ids=lambda hidden: " ".join(kind.__name__ for kind in hidden) or "nothing",
)  # fmt: skip
def test_the_search_finds_the_best_of_all_subsets(null, changes, hidden):
    held = recorded(null, changes, hidden, 8)
    found = Search(held, KINDS).run()
    every = []
    for many in range(MOST_CAUSES + 1):
        for kinds in combinations(KINDS, many):
            every.append(option(held, [kind(hidden.get(kind, 1.0)) for kind in kinds], (), len(KINDS)))
    best = max(every, key=lambda each: each.log_posterior)
    assert found[0].causes == best.causes
    assert found[0].log_posterior == pytest.approx(best.log_posterior, abs=0.1)
    if hidden and min(map(abs, hidden.values())) > 0.2:
        assert {type(effect) for effect in found[0].effects} == set(hidden)


@pytest.mark.usefixtures("_chain")
def test_the_search_finds_an_effect_beside_a_regularity(null, changes):
    stray = 3 * columns(STRAY, null)[:, 0]
    best = Search(recorded(null, changes, {Dip: 1.0}, 9, 2 * stray), KINDS).run()[0]
    assert [type(effect) for effect in best.effects] == [Dip]
    assert [each.atom for each in best.regularities] == [STRAY]


def decided(held):
    return decide(held.measured, held.unit, KINDS)


def drawn_size(rng):
    """A size in standard deviations: its logarithm is uniform, and below one all sizes are equally probable."""
    return rng.uniform() if rng.uniform() < 1 / (1 + LOG_SIZE_RANGE) else np.exp(rng.uniform(0, LOG_SIZE_RANGE))


@pytest.mark.slow
@pytest.mark.end_to_end
def test_probabilities_are_true(monkeypatch):
    """Effects drawn from the prior, with form errors: of answers given with a probability, that share is right."""
    small_layout = Layout(("T_in",))
    toy = fitted_to(small_layout, np.random.default_rng(10), open_=1)
    toy = replace(toy, errors=Covariance(toy.errors.alone, np.zeros((len(toy.residual), 0))))
    columns_ = signatures_of(toy, np.random.default_rng(11))
    patch_chain(monkeypatch, toy, columns_)
    kinds, rng, D = (Bump, Mimic), np.random.default_rng(12), {}
    for kind in kinds:
        one = option(holding(toy, 0 * toy.residual), (kind(1.0),), (), 2).fitted
        lone = replace(one, calibrated=replace(one.calibrated, model=toy.unit.model.plus(kind(1.0))))
        (D[kind],) = form_directions(lone)
    # Each kind is not there, or it is, or something unknown resembles it.
    states = list(product(("no", "yes", "like"), repeat=2))
    counts = [(each.count("yes"), each.count("like")) for each in states]
    # Sizes below the standard deviation belong to the prior too.
    small = 1 + 1 / LOG_SIZE_RANGE
    prior = np.array([np.exp(log_prior(n, like, 0, len(kinds))) * small ** (n + like) for n, like in counts])
    stated, right = [], []
    for _ in range(200):
        truth = dict(zip(kinds, states[rng.choice(len(states), p=prior / prior.sum())], strict=True))
        signal = drawn(toy.whole, rng)
        forms = {"yes": rng.choice(FORM_ERRORS), "like": rng.choice(OTHER_FORMS, p=uniform_weights(OTHER_FORMS))}
        for kind in kinds:
            if truth[kind] == "no":
                continue
            whole = columns_[kind].ravel()
            white = toy.whole.whiten(whole)
            least = 1 / np.sqrt(white @ white)
            size = rng.choice([-1, 1]) * least * drawn_size(rng)
            signal = signal + size * (whole + forms[truth[kind]] * D[kind] @ rng.standard_normal(D[kind].shape[1]))
        held = holding(toy, signal)
        none, *alone = (option(held, each, (), len(kinds)) for each in ((), (Bump(1.0),), (Mimic(1.0),)))
        # Two effects are fitted as the search does it: beside one whose form is open.
        others = zip(alone, kinds[::-1], strict=True)
        both = [option(one.opened(*one.likeliest), (other(1.0),), (), len(kinds)) for one, other in others]
        plain = [none, *alone, max(both, key=lambda each: each.log_posterior)]
        every = [*plain, *(like for each in plain for like in resembling(each, len(kinds)))]
        log_posterior = np.array([each.log_posterior for each in every])
        probabilities = np.exp(log_posterior - logsumexp(log_posterior))
        by_answer: dict[object, float] = {}
        for each, probability in zip(every, probabilities.tolist(), strict=True):
            answer = frozenset(map(type, each.effects)), each.unknown
            by_answer[answer] = by_answer.get(answer, 0.0) + probability
        first = max(by_answer, key=lambda each: by_answer[each])
        stated.append(by_answer[first])
        right.append(first == (frozenset(k for k in kinds if truth[k] == "yes"), "like" in truth.values()))
    stated, right = np.array(stated), np.array(right)
    for low, high in ((0, 0.9), (0.9, 1.01)):
        here = (low <= stated) & (stated < high)
        assert here.sum() >= 5
        expected, count = stated[here].mean(), int(here.sum())
        within = binom.ppf([0.002, 0.998], count, expected)
        assert within[0] <= right[here].sum() <= within[1]
    assert right.mean() > 0.7


def answered(null, changes, hidden, seed, more=0.0, **given):
    """The answer about recordings with effects, and its sentence."""
    held = recorded(null, changes, hidden, seed, more)
    found = Answer(decided(held), (), (), (), (), (), **given)
    return found, sentence(found, found_effects(found))


@pytest.mark.usefixtures("_chain")
def test_an_effect_is_reported_with_its_probability_and_size(null, changes):
    found, said = answered(null, changes, {Dip: 3.0}, 13)
    (effect,) = found_effects(found)
    assert found.verdict == FOUND
    assert effect["probability"] > 0.95
    assert said.startswith("The model lacks a dip: ")
    assert said.endswith(f": probability {probability_text(found.decision.probability)}.")
    low, high = effect["parameters"]["height"]["ci95"]
    assert low < 3 < high < low + 1
    first, *others = options(found)
    assert (first["words"], first["regularities"], first["log_ratio"]) == ("a dip", [], 0)
    assert all(other["log_ratio"] < 0 for other in others)
    assert sum(each["probability"] for each in options(found)) == pytest.approx(1, abs=0.01)
    assert effect["evidence"]["gain"] > 100
    assert found.decision.gain_of(Bump(1.0)) == 0
    assert small(found) == []


@pytest.mark.usefixtures("_chain")
def test_what_looks_alike_is_an_alternative_in_report_and_sentence(null, changes):
    """A weak bump and its mimic, which no recording tells apart."""
    alike = {**changes, Mimic: 1.0001 * changes[Bump]}
    with pytest.MonkeyPatch.context() as patch:
        patch_chain(patch, null, alike)
        found, said = answered(null, alike, {Bump: 2.0}, 14)
    assert {each["words"] for each in alternatives(found)} == {"a bump", "a mimic"}
    assert all(each["probability"] == pytest.approx(0.5, abs=0.05) for each in alternatives(found))
    assert sum(each["probability"] for each in alternatives(found)) >= CREDIBLE
    ((rival, probability),) = found.decision.credible[1:]
    words = {"Bump": "a bump", "Mimic": "a mimic"}[type(rival.effects[0]).__name__]
    assert f": probability {probability_text(found.decision.probability)}; else {words} ({probability:.2f})." in said
    assert not any(each["unknown"] for each in alternatives(found))


@pytest.mark.usefixtures("_chain")
def test_nothing_and_something_unknown_have_probabilities_too(null, changes):
    found, said = answered(null, changes, {}, 15)
    assert found.verdict == NOTHING
    assert said.startswith("Nothing is missing: the model explains the recordings down to their noise: probability ")
    assert alternatives(found)[0] == {
        "words": "nothing", "effects": [], "unknown": False, "probability": pytest.approx(found.decision.probability),
    }  # fmt: skip
    found, said = answered(null, changes, {}, 16, 3 * columns(STRAY, null)[:, 0])
    assert found.verdict == UNKNOWN
    assert [each.atom for each in found.unknown] == [STRAY]
    assert "not in the library: order 5, in s1 alone, constant" in said
    assert said.endswith(f": probability {probability_text(found.decision.probability)}.")
    assert alternatives(found)[0]["unknown"]
    assert options(found)[0]["words"] == "something unknown"


@pytest.mark.usefixtures("_chain")
def test_what_is_too_small_to_matter_is_seen_but_no_verdict(null, changes):
    found, _ = answered(null, changes, {Dip: 3.0}, 13)
    (far,) = found.shares_of_spread
    assert answered(null, changes, {Dip: 3.0}, 13, interest=0.9 * far)[0].verdict == FOUND
    found, said = answered(null, changes, {Dip: 3.0}, 13, interest=1.1 * far)
    assert found.verdict == NOTHING
    (seen,) = small(found)
    assert seen["words"].startswith("a dip")
    assert seen["share"] == pytest.approx(far, rel=1e-3)
    assert "seen, but too small to matter: a dip" in said
    assert "probability" not in said
    assert found_effects(found) == []


@pytest.mark.usefixtures("_chain")
def test_what_is_described_changes_no_ratio(null, changes):
    """An unknown cause may be described by another option than the most probable one."""
    found, _ = answered(null, changes, {Dip: 30.0}, 13)
    least, _ = found.decision.weighed[-1]
    described = replace(found, decision=replace(found.decision, best=least))
    assert options(described) == options(found)
    assert described.decision.gain_of(Dip(1.0)) == found.decision.gain_of(Dip(1.0))


def test_two_of_a_kind_are_other_causes_than_one_of_them():
    assert causes_of([Dip(1.0), Dip(2.0)], []) != causes_of([Dip(1.0)], [])
    assert causes_of([Dip(1.0), Bump(2.0)], []) == causes_of([Bump(1.0), Dip(1.0)], [])


@pytest.mark.usefixtures("_chain")
def test_what_describes_a_cause_is_as_large_as_the_cause(null, changes):
    """A regularity that is too small to matter is all that is left to describe of a cause that resembles a dip."""
    large, _ = answered(null, changes, {Dip: 30.0}, 13)
    like = next(each for each, _ in large.decision.weighed if each.resembled)
    tiny, _ = answered(null, changes, {}, 16, 3 * columns(STRAY, null)[:, 0])
    (share,), (of_dip,) = tiny.shares_of_spread, large.shares_of_spread
    interest = (share + of_dip) / 2
    assert share < interest < of_dip
    alone = replace(tiny, interest=interest)
    assert alone.verdict == NOTHING
    described = replace(alone, decision=replace(tiny.decision, answers=((like, 1.0),)))
    assert described.shares_of_spread == pytest.approx([of_dip], rel=1e-3)
    assert described.verdict == UNKNOWN


@pytest.mark.usefixtures("_chain")
def test_a_regularity_of_high_orders_alone_has_not_the_probability_of_the_order_lines(null, changes):
    held = recorded(null, changes, {}, 15)
    found = Answer(decided(held), (), (), (), (describe(held)[0],), ())
    assert found.verdict == UNKNOWN
    assert "probability" not in sentence(found, [])
