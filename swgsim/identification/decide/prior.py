"""The prior of the decision: one table, which holds every number that the decision has.

An option is a set of causes that the model may lack. All numbers are estimates, declared before any scored run. They
change only for a reason from physics or from the practice of test benches.
"""

import numpy as np

from swgsim.effects.regularity import LAWS, PATTERNS
from swgsim.identification.data.features import ORDERS

# Probability of 0, 1, 2, 3 causes. Most gears that are examined are healthy, and independent causes at once are rare:
# each further one is five times less probable.
CAUSES = (0.8, 0.16, 0.032, 0.008)
# Probability that a cause is not in the library, which holds what the literature describes.
UNKNOWN = 0.1
# An unknown cause acts on the same machine as the known ones. Half of the unknown causes are taken to resemble a known
# effect, as many effects of the library resemble another one; the others are a few regularities.
RESEMBLING = 0.5
# Probability that an unknown cause shows in one more regularity. A regularity is one order, one pattern over the
# channels and one law; a real cause shows in several, which have one of the three in common.
ANOTHER_REGULARITY = 0.5
# Probability that bridges were balanced anew between two sessions. The zeros of gauges then lie so many times as far
# off as declared.
BALANCED, TIMES_BALANCED = 0.05, (2.0, 4.0, 8.0, 16.0)
# A real effect never has exactly the form that the library gives it. The lines of its signature differ by one of these
# shares (standard deviation), all being equally probable: from the mesh of the truss to the model of another author.
FORM_ERRORS = (0.01, 0.02, 0.05, 0.1, 0.2)
# The lines of an unknown cause differ by any share from those of the effect that it resembles: it may look just like
# it, or have nothing but the channels, orders and law in common.
UNKNOWN_FORMS = (*FORM_ERRORS, 0.5, 1.0)
# Sizes of effects and amplitudes of regularities are known to a factor only: their logarithm is uniform over so many
# factors of e, a ratio of 3000.
SCALES = 8.0


def log_prior(effects: int, regularities: int, kinds: int, resembling: int = 0) -> float:
    """Logarithm of the prior probability of an option.

    Parameters
    ----------
    effects : int
        Effects of the library; each is as probable as any other one.
    regularities : int
        Together they are one unknown cause. The first may be any; further ones have order, pattern or law in common.
    kinds : int
        Number of effects in the library.
    resembling : int
        So many of the effects are not there, but unknown causes that resemble them.

    >>> round(float(np.exp(log_prior(0, 0, 60))), 3)
    0.8
    >>> round(float(np.exp(log_prior(1, 0, 60))), 4)
    0.0024
    """
    causes = effects + bool(regularities)
    if causes >= len(CAUSES):
        return -np.inf
    known = effects * np.log((1 - UNKNOWN) / kinds) + np.log(np.arange(1, effects + 1)).sum()  # in any order
    known += resembling * np.log(UNKNOWN * RESEMBLING / (1 - UNKNOWN))
    first = UNKNOWN * (1 - RESEMBLING) * (1 - ANOTHER_REGULARITY) / ((ORDERS + 1) * len(PATTERNS) * len(LAWS))
    further = ANOTHER_REGULARITY / (ORDERS + len(PATTERNS) + len(LAWS))
    unknown = np.log(first) + (regularities - 1) * np.log(further) if regularities else 0.0
    return float(np.log(CAUSES[causes]) + known + unknown)
