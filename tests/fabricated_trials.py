"""Trials of effects with a size and nothing else, with fabricated evidence."""

from dataclasses import dataclass, replace

import numpy as np
from loop_fixtures import BUMP, WAVE, Bump, Wave, fitted_to
from swgsim.identification.decide.candidate import Trial

from swgsim.identification.data.features import Layout
from swgsim.identification.fit.form_error import Coherence
from swgsim.identification.search.hypotheses import Hypothesis
from swgsim.identification.search.screening import Score

FITTED = fitted_to(Layout(("T_in", "s1")), np.random.default_rng(1))


@dataclass(frozen=True)
class Dip(Bump):
    """Another effect."""


@dataclass(frozen=True)
class Mimic(Bump):
    """An effect that looks like a bump."""


def tried(hypothesis: Hypothesis, evidence: float = 1000.0, agrees: float = 1.0) -> Trial:
    """An effect that pays, the same on all operating points."""
    score = Score(hypothesis, 100.0, 1, 1.0, 0.0, 0.1, 1.0, 1e-6)
    return Trial(score, (hypothesis.kind(1.0),), FITTED, np.full(6, 50.0), evidence, (Coherence(agrees, 0.0, 0.0),))


A, B, C, MIMIC = (tried(each) for each in (BUMP, WAVE, Hypothesis(Dip, (), 1), Hypothesis(Mimic, (), 1)))
PAIR = replace(A, effects=(Bump(1.0), Wave(1.0)))
