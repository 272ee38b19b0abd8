"""False alarms where the errors of single recordings are known from few repeats only."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import BUMP, POINTS, fitted_to, holding
from scipy.stats import binom

from swgsim.gear.conditions import Conditions
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.repeats import from_repeats
from swgsim.identification.covariance.scatter import STATED, Scatter, kinds, trends
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Situation
from swgsim.identification.search.screening import screen

LAYOUT = Layout(("T_in", "s0"))
KINDS = kinds(LAYOUT)
REPEATS, TRIALS = 3, 60
GROUPS = [point for point in range(len(POINTS)) for _ in range(REPEATS)]


def chances(*, known: bool) -> np.ndarray:
    """Chance of the best score in data without an effect, each with errors of its own size."""
    rng = np.random.default_rng(1)
    fitted = fitted_to(LAYOUT, rng, repeats=REPEATS, open_=3)
    stated = np.array([STATED[kind] for kind in KINDS])
    B = rng.normal(size=(len(POINTS), len(LAYOUT), len(KINDS))) * 10 ** rng.uniform(-0.5, 1, len(KINDS))
    B = (B / stated)[GROUPS]
    # The gear warms while it is recorded.
    situations = [Situation(POINTS[group], Conditions(25 + 0.4 * i, 60.0 * i)) for i, group in enumerate(GROUPS)]
    following = trends(B, situations, LAYOUT)
    # Effects that act as the errors do, but by another law over the operating points.
    laws = rng.normal(size=(len(POINTS), len(KINDS), 2 * len(KINDS)))[GROUPS]
    laws *= np.tile(np.eye(len(KINDS)), 2)
    signatures = np.einsum("rfk,rkh->rfh", B * stated, laws).reshape(-1, 2 * len(KINDS))
    found = []
    for _ in range(TRIALS):
        sd = stated * np.exp(rng.normal(0, np.log(2), len(KINDS)))
        noise = np.sqrt(fitted.measured.variance) * rng.standard_normal(fitted.measured.variance.shape)
        r = np.einsum("rfk,rk->rf", B, sd * rng.standard_normal((len(GROUPS), len(KINDS)))) + noise
        guess = from_repeats(
            r, RecordingCovariance.white(fitted.measured.variance), B, following, GROUPS, Scatter.stated(LAYOUT)
        )
        if known:
            guess = Scatter(dict(zip(KINDS, sd.tolist(), strict=True)), 1000, np.zeros((len(KINDS), len(KINDS))))
        errors = Covariance(RecordingCovariance(fitted.measured.variance, guess.columns(B)), np.zeros((r.size, 0)))
        r = r.ravel() + fitted.open @ rng.standard_normal(3)
        now = replace(holding(fitted, r), scatter=guess, errors=errors)
        scores = screen([BUMP] * signatures.shape[1], np.split(signatures, signatures.shape[1], axis=1), now, rng)
        found.append(min(score.chance for score in scores))
    return np.array(found)


@pytest.mark.parametrize("known", [True, False])
def test_false_alarms_are_as_rare_as_they_claim(known):
    found = chances(known=known)
    assert (found <= 0.02).sum() <= binom.ppf(0.999, TRIALS, 0.02)
    assert (found <= 0.1).sum() <= binom.ppf(0.999, TRIALS, 0.1)
