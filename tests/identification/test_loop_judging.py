"""An effect beside a bare regularity: the same thing told better, another thing, or one that dwarfs it."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import BUMP, Bump, drawn, fitted_to, holding
from swgsim.identification.decide.candidate import Trial, gained
from swgsim.identification.decide.competing_regularities import beside_unknown, in_company, more_than, outdone

from swgsim.effects.regularity import OF_TIME
from swgsim.gear.conditions import Conditions
from swgsim.identification.covariance.low_rank_covariance import Covariance, as_squares
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.decide import candidate as trial_module
from swgsim.identification.fit import form_error as evidence
from swgsim.identification.fit.fitted import LIKELIER_BALANCED
from swgsim.identification.search import regularities as vocabulary
from swgsim.identification.search.regularities import Atom, columns, describe, set_free, strongest
from swgsim.identification.search.screening import Score

LAYOUT = Layout(("T_in", "s1", "s2", "s3", "s4"))
STRAY = Atom(5, "in s2 alone", "constant")


@pytest.fixture
def fitted():
    return fitted_to(LAYOUT, np.random.default_rng(1), repeats=2)


@pytest.fixture
def stray(fitted):
    """A regularity of a gain of about 400."""
    column = columns(STRAY, fitted)[:, 0]
    return 20 * column / np.linalg.norm(fitted.whole.whiten(column))


@pytest.fixture
def signature(fitted, stray):
    """An effect of a gain of about 900 on order 2, with hardly a trace of where that regularity is."""
    rng = np.random.default_rng(2)
    form = rng.standard_normal((len(fitted.measured.situations), len(LAYOUT))) * (LAYOUT.order == 2)
    whole = fitted.measured.rows(form)
    return 30 * whole / np.linalg.norm(fitted.whole.whiten(whole)) + 0.1 * stray


def trial(fitted, signature) -> Trial:
    """An effect with this signature, fitted; what is left of the residual is that of the fit."""
    score = Score(BUMP, 100.0, 1, 1.0, 0.0, 0.1, 1.0, 1e-6)
    fitted = replace(fitted, calibrated=replace(fitted.calibrated, model=Model(GEAR, (Bump(1.0),))))
    found = Trial(score, (Bump(1.0),), fitted, np.full(6, 50.0), 100.0, (evidence.coherence(fitted, -1),))
    found.__dict__["signature"] = signature[:, None]
    return found


@pytest.fixture(autouse=True)
def _signature_of_the_effect(signature, monkeypatch):
    monkeypatch.setattr(evidence, "signature", lambda fitted, number: signature)
    # Nothing of a fabricated model can be fitted again.
    monkeypatch.setattr(vocabulary, "extended", lambda fitted, _: fitted)


def named(fitted, atom: Atom):
    return next(each for each in describe(fitted) if each.atom == atom)


def test_a_regularity_that_tells_the_same_better_outdoes_an_effect(fitted, stray, signature):
    rng = np.random.default_rng(3)
    mimic = stray + 0.5 * np.linalg.norm(stray) / np.linalg.norm(signature) * signature
    now = holding(fitted, 2 * stray + drawn(fitted.whole, rng))
    assert outdone(trial(now, mimic), named(now, STRAY), now)


@pytest.mark.parametrize(("share", "its_own"), [(0.3, False), (0.4, True)])
def test_a_third_of_what_an_effect_is_credited_with_is_its_own(fitted, signature, share, its_own):
    judged = trial(fitted, signature)
    judged = replace(judged, own=share * as_squares(judged.evidence))
    judged.__dict__["signature"] = signature[:, None]
    assert judged.pays == its_own
    assert np.isfinite(judged.merit) == its_own


def test_another_thing_of_like_size_does_not_outdo_an_effect(fitted, stray, signature):
    now = holding(fitted, signature + 2 * stray + drawn(fitted.whole, np.random.default_rng(4)))
    plain = named(now, STRAY)
    assert plain.gain > 1.2 * trial(now, signature).explained(now)
    assert not outdone(trial(now, signature), plain, now)


def test_what_dwarfs_an_effect_makes_it_doubtful(fitted, stray, signature):
    now = holding(fitted, signature + 6 * stray + drawn(fitted.whole, np.random.default_rng(5)))
    assert outdone(trial(now, signature), named(now, STRAY), now)


def test_a_regularity_that_is_set_free_is_gone(fitted, stray):
    now = holding(fitted, stray + drawn(fitted.whole, np.random.default_rng(6)))
    found = strongest(now, np.random.default_rng(0))
    assert found.atom == STRAY
    assert found.chance < 0.01
    assert named(set_free(now, found), STRAY).gain < 20


def test_an_effect_is_accepted_in_the_company_of_a_regularity(fitted, stray, signature):
    noise = drawn(fitted.whole, np.random.default_rng(7))
    now, after = holding(fitted, signature + stray + noise), holding(fitted, stray + noise)
    alone = trial(after, signature)
    assert not alone.sound
    found = in_company(now, alone, 0)
    assert found.sound
    assert found.effects == alone.effects


def test_an_effect_that_lives_off_a_regularity_is_not(fitted, stray, signature):
    """Once the regularity is out nothing of the effect is left."""
    noise = drawn(fitted.whole, np.random.default_rng(8))
    now = holding(fitted, 2 * stray + noise)
    mimic = stray + 0.1 * np.linalg.norm(stray) / np.linalg.norm(signature) * signature
    after = holding(fitted, 2 * stray - mimic + noise)
    assert in_company(now, trial(after, mimic), 0) is None


@pytest.mark.parametrize(("share", "rival"), [(0.0, True), (0.7, False)], ids=["another thing", "mostly the same"])
def test_an_effect_that_only_what_is_unknown_contradicts_may_be_a_rival(fitted, stray, signature, share, rival):
    noise = drawn(fitted.whole, np.random.default_rng(7))
    after = holding(fitted, stray + noise)
    taken = stray * np.linalg.norm(fitted.errors.whiten(signature)) / np.linalg.norm(fitted.errors.whiten(stray))
    alone, unknown = trial(after, np.sqrt(1 - share) * signature + np.sqrt(share) * taken), named(after, STRAY)
    assert not alone.sound
    found = beside_unknown(alone, (unknown,))
    assert (found is not None) == rival
    if rival:
        assert found.sound
        assert found.beside == (unknown,)
    assert beside_unknown(alone, ()) is None


def scattered(fitted, factor: float):
    """A fit whose recordings also err in two ways, by so much."""
    moves = np.random.default_rng(5).standard_normal((*fitted.measured.values.shape, 2))
    scatter = Scatter({"load": factor, "speed": 2.0}, 6, 0.1 * np.eye(2))
    alone = RecordingCovariance(fitted.measured.variance, scatter.columns(moves))
    return replace(fitted, scatter=scatter, errors=replace(fitted.errors, base=alone))


def behind_the_stray(fitted, stray, effect, rest, own):
    """Three things: a model in which the stray line is free, and the gear has a line of its own there, `own` times as
    large; an effect found behind the stray line; and this line as it was described.
    """
    now = holding(fitted, stray + effect + rest)
    plain = named(now, STRAY)
    predicted = own * plain.amplitude * (LAYOUT.order == 5) * np.ones_like(now.calibrated.predicted)
    measured = replace(
        now.measured, values=now.measured.values + now.measured.rows(predicted).reshape(now.measured.values.shape)
    )
    free = set_free(replace(now, measured=measured, calibrated=replace(now.calibrated, predicted=predicted)), plain)
    return free, trial(set_free(holding(fitted, stray + rest), plain), effect), plain


@pytest.mark.parametrize(
    ("share", "left", "own", "law", "another"),
    [
        (1.0, None, 1e3, "constant", True),
        (1.0, "s2", 1e3, "constant", False),
        (1.0, "s3", 1e3, "constant", True),
        (0.05, None, 0.1, "constant", True),
        (0.05, None, 1e3, "constant", False),
        (0.05, None, 0.1, OF_TIME, False),  # at the time of these recordings such a disturbance is nothing yet
        (0.05, "s2", 0.1, "constant", False),
    ],
)
def test_what_is_more_than_a_part_of_a_disturbance(fitted, stray, signature, share, left, own, law, another):
    """It shows elsewhere, or the disturbance is no line of the gear's own; and no more of its channel is left."""
    there = np.tile(LAYOUT.channel == "s2", len(fitted.measured))
    effect = np.where(there, signature, share * signature)
    rest = drawn(fitted.whole, np.random.default_rng(3))
    if left:
        more = columns(Atom(7, f"in {left} alone", "constant"), fitted)[:, 0]
        rest += 30 * more / np.linalg.norm(fitted.whole.whiten(more))
    free, found, plain = behind_the_stray(fitted, stray, effect, rest, own)
    assert found.explained(free) > 50
    disturbance = replace(plain, atom=replace(plain.atom, law=law))
    assert more_than([disturbance], found, free, 0) == another


@pytest.fixture
def on_line_and_beyond(fitted, stray):
    """Signatures of one size: of what goes with the stray line, and of all but it."""
    form = np.random.default_rng(5).standard_normal((len(fitted.measured.situations), len(LAYOUT)))
    line = (LAYOUT.channel == "s2") & (LAYOUT.order == STRAY.order)
    rows = stray, fitted.measured.rows(form * ~line)
    return tuple(100 * row / np.linalg.norm(fitted.errors.whiten(row)) for row in rows)


@pytest.mark.parametrize(("elsewhere", "another"), [(0.1, False), (0.5, True)])
def test_what_is_hardly_more_than_the_line_of_a_disturbance_is_a_part_of_it(
    fitted, stray, on_line_and_beyond, elsewhere, another
):
    """Though the disturbance, which is free, leaves nothing of it to be seen there."""
    on_line, beyond = on_line_and_beyond
    effect = np.sqrt(1 - elsewhere) * on_line + np.sqrt(elsewhere) * beyond
    rest = drawn(fitted.whole, np.random.default_rng(3))
    free, found, plain = behind_the_stray(fitted, stray, effect, rest, own=1e3)
    assert found.explained(free) > 50
    assert more_than([plain], found, free, 0) == another


def test_of_a_pair_one_effect_may_be_the_line_of_a_disturbance(fitted, stray, on_line_and_beyond):
    on_line, beyond = on_line_and_beyond
    rest = drawn(fitted.whole, np.random.default_rng(3))
    free, found, plain = behind_the_stray(fitted, stray, on_line + beyond, rest, own=0.1)
    for signatures, another in (((on_line, beyond), True), ((on_line, on_line), False)):
        found.__dict__["signature"] = np.stack(signatures, axis=1)
        assert more_than([plain], found, free, 0) == another


def test_other_errors_of_single_recordings_are_those_it_would_have_been_given(fitted):
    found, expected = scattered(fitted, 1.0).scattering(scattered(fitted, 7.0).scatter), scattered(fitted, 7.0)
    assert found.scatter.sd == expected.scatter.sd
    np.testing.assert_allclose(found.errors.alone.C, expected.errors.alone.C)


def test_what_larger_errors_of_single_recordings_explain_is_no_merit_of_an_effect(fitted):
    """Thermal output that is not there drifts from repeat to repeat; zeros that scatter more then hide an offset."""
    truth = scattered(fitted, 10.0)
    residual = drawn(truth.whole, np.random.default_rng(6))
    now, after = holding(scattered(fitted, 1.0), residual), holding(truth, residual)
    assert after.log_likelihood - now.log_likelihood > 100
    points, together = gained(now, after)
    np.testing.assert_allclose(points, 0, atol=1e-6)
    assert together == pytest.approx(0, abs=1e-6)


def test_smaller_errors_of_single_recordings_are(fitted):
    """An effect that explains why repeats differ."""
    small = scattered(fitted, 1.0)
    calm = drawn(small.whole, np.random.default_rng(7))
    differing = drawn(scattered(fitted, 10.0).whole, np.random.default_rng(8))
    points, together = gained(holding(scattered(fitted, 10.0), differing), holding(small, calm))
    assert points.sum() > 20
    assert together > 20


GAUGES = Layout(("s0", "s1", "s2", "s3", "s4"))


@pytest.fixture
def of_zeros():
    """A model whose gauges have noise of 0.1 uV/V and zeros of a session, and the same with the means moved."""
    fitted = fitted_to(GAUGES, np.random.default_rng(1), repeats=2, open_=0)
    measured = replace(fitted.measured, variance=1e-8 * fitted.measured.variance)
    errors = Covariance(
        RecordingCovariance.white(measured.variance), measured.session_columns(fitted.calibrated.predicted)
    )
    fitted = replace(fitted, measured=measured, errors=errors)

    def moved(*zeros: float):
        residual = np.tile(np.where(GAUGES.order == 0, np.repeat(zeros, len(GAUGES) // 5), 0.0), len(measured))
        residual += drawn(Covariance(errors.alone, errors.G[:, :0]), np.random.default_rng(2))
        held = holding(fitted, residual)
        return replace(held, errors=replace(errors, G=held.measured.session_columns(held.calibrated.predicted)))

    return moved


def test_bridges_that_were_balanced_anew_are_told_by_their_zeros(of_zeros):
    calm = of_zeros(0.004, -0.006, 0.002, -0.004, 0.005)
    assert calm.balanced is calm
    hardly = of_zeros(0.008, -0.01, 0.008, -0.009, 0.009)
    assert 0 < hardly.with_zeros(2.0).log_likelihood - hardly.log_likelihood < LIKELIER_BALANCED
    assert hardly.balanced is hardly
    anew = of_zeros(0.03, -0.045, 0.015, -0.03, 0.04)
    assert anew.balanced.measured.zeros in (4.0, 8.0)
    further = anew.whole.with_columns(anew.measured.further_zeros(anew.balanced.measured.zeros))
    assert anew.balanced.log_likelihood == pytest.approx(further.log_likelihood(anew.residual))
    assert anew.balanced.balanced is anew.balanced


def test_a_zero_that_moves_during_a_session_is_no_matter_of_balancing():
    """As where the temperature moves it; balancing moves it once."""
    hours = np.linspace(0, 0.5, 6)
    fitted = fitted_to(GAUGES, np.random.default_rng(1), open_=0)
    recordings = [
        replace(each, conditions=Conditions(elapsed=3600 * at))
        for each, at in zip(fitted.measured.recordings, hours, strict=True)
    ]
    measured = replace(fitted.measured, recordings=tuple(recordings), variance=1e-6 * fitted.measured.variance)
    errors = Covariance(
        RecordingCovariance.white(measured.variance), measured.session_columns(fitted.calibrated.predicted)
    )
    fitted = replace(fitted, measured=measured, errors=errors)
    zeros = np.where(GAUGES.order == 0, np.repeat([0.04, -0.03, 0.05, -0.04, 0.03], len(GAUGES) // 5), 0.0)
    still, moving, calm = (holding(fitted, np.outer(by, zeros).ravel()) for by in (1 + 0 * hours, 2 * hours, 0 * hours))
    assert gained(moving, calm)[1] > 10 * gained(still, calm)[1]


def test_bridges_balanced_anew_are_as_unlikely_beside_an_effect_as_beside_nothing(of_zeros):
    anew, named = of_zeros(0.03, -0.045, 0.015, -0.03, 0.04), of_zeros(0.0, 0.0, 0.0, 0.0, 0.0)
    over = named.log_likelihood - anew.balanced.log_likelihood
    assert gained(anew, named)[1] == pytest.approx(over + LIKELIER_BALANCED)


def test_an_effect_must_explain_zeros_better_than_bridges_balanced_anew_do(of_zeros):
    """An effect that would move two of five gauges, and leave three where they were, or where they are as far off."""
    for rest, pays in ((0.004, True), (0.04, False)):
        now, after = of_zeros(0.3, -0.3, rest, -rest, rest), of_zeros(0.0, 0.0, rest, -rest, rest)
        _, together = gained(now, after)
        assert (together > trial_module.LIKELIER) == pays
        assert after.log_likelihood - now.log_likelihood > 1000
