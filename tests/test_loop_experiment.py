"""What to record next: as the bench stands, unless only something else decides the question."""

import numpy as np
import pytest

from swgsim.loop.experiment import FEASIBLE, SEPARATED, easiest

PLAIN, WARM = 0, len(FEASIBLE)


@pytest.mark.parametrize(
    ("plain", "warm", "chosen"),
    [
        (SEPARATED + 1, 10 * SEPARATED, PLAIN),  # decides the question, however much better another would
        (SEPARATED - 2, SEPARATED + 3, WARM),  # nearly as good, but does not decide it
        (9.0, 10.0, PLAIN),  # neither does
        (5.0, 10.0, WARM),
    ],
)
def test_the_easiest_recording_that_decides(plain, warm, chosen):
    separations = np.zeros(len(FEASIBLE) + 1)
    separations[[PLAIN, WARM]] = plain, warm
    assert easiest(separations) == chosen
