"""How far a friction model may be trusted at rest: Coulomb friction of a joint that stands has any size."""

from dataclasses import replace

import numpy as np

from swgsim.joint.regression import Fit, fit
from swgsim.joint.textbook import Friction


def trusted(textbook: Fit) -> Fit:
    """The textbook model, fitted by generalised least squares.

    Coulomb friction is set-valued. Whatever holds a joint at rest lies within plus and minus Coulomb friction Fc, and
    no function of the motion says where. So its variance at rest is that of a uniform distribution, Fc^2 / 3, besides
    that of the noise; where the joint moves it is that of the noise. One standstill is one such number, however many
    samples it has: n samples of it say no more of the mean than one, so each has n times the variance.
    """
    table = textbook.table
    friction = next((term for term in textbook.terms if isinstance(term, Friction)), None)
    if friction is None:
        return textbook
    width, lag = (friction.sign_width, friction.lag) if any(each.reverses for each in table.recordings) else (0.0, 0.0)
    rest = np.concatenate([each.rest(width, lag) for each in table.recordings])
    noise = np.average(textbook.residual**2, weights=1 - rest)
    shared = np.bincount(table.stretch, rest)[table.stretch]
    trust = np.sqrt(noise / (noise + shared * rest * friction.weights[0] ** 2 / 3))
    return fit(replace(table, trust=trust), textbook.terms)
