"""Detection limit: the smallest size of an effect that is significant, also if its signature depends on the size."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.search.hypotheses import signatures
from swgsim.identification.search.screening import DEVIATIONS_AT_LIMIT, Score, rank

# Visible share of a signature below which it is computed again at the detection limit; for an effect with a threshold
# it always is.
MOSTLY_ABSORBED = 0.1


def at_sizes_seen(scores: Sequence[Score], fitted: Fitted) -> tuple[Score, ...]:
    """Scores with the deviation that effects have at the smallest size that would be seen.

    A signature is taken at typical size. Of a fifth less stiffness a declared stiffness does not absorb quite all, as
    neither acts in a straight line; of a thirtieth it does. Where half the size leaves a quarter to be seen, as of a
    curve, the geometric mean of a size and of the one that would be seen by the signature there is the right one. Of
    clipping nothing is seen below its threshold.
    """
    there = [
        replace(score.hypothesis, reference=score.value_at_limit)
        for score in scores
        if score.within_bounds and (score.visible < MOSTLY_ABSORBED or score.hypothesis.kind.sharp)
    ]
    if not there:
        return tuple(scores)
    again = rank(there, signatures(there, fitted.model, fitted.measured), fitted)
    deviation = {score.hypothesis.kind: score.deviation for score in again}
    return tuple(_between(score, deviation.get(score.hypothesis.kind, score.deviation)) for score in scores)


def _between(score: Score, deviation: float) -> Score:
    """With the mean of both deviations; the size of the signature is known to be seen, unless it is smaller yet."""
    most = max(score.deviation, score.size_of_signature / DEVIATIONS_AT_LIMIT)
    return replace(score, deviation=min(float(np.sqrt(score.deviation * deviation)), most))
