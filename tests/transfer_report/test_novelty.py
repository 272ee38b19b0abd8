"""Novelty of gears whose healthy references are known to differ, and what is said of it."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings

from learn.transfer_report import novelty
from swgsim.storage import storage


def gears_with(folder, name, gain, gears=8):
    """A data set whose signals are scaled."""
    made = recordings(gears=gears, variants=1, disturbance=1e-3)
    storage.write(folder / f"{name}.h5", [replace(made, signals=made.signals * np.float32(gain))], len(made))
    return folder / f"{name}.h5"


def test_novelty_tells_gears_from_another_population(tmp_path):
    bench, far = gears_with(tmp_path, "a", 1.0), gears_with(tmp_path, "b", 1.5, gears=3)
    errors = pd.Series([5.0, 9.0, 7.0], [1, 2, 3])
    found = novelty.novelty(bench, far, errors)
    assert list(found.usual.index) == [1, 2, 3]
    assert (found.foreign > 3 * found.threshold).all()
    said = found.sentences("any method")
    assert "The 3 gears of grid=far" in said
    assert "3 of them exceed" in said
    assert "(AUROC) is 1.00" in said


@pytest.mark.parametrize(("errors", "verdict"), [((1, 2, 3, 4, 5, 6), " goes"), ((2, 1, 4, 3, 1, 2), "not clearly")])
def test_novelty_is_set_beside_the_error(errors, verdict):
    usual = pd.DataFrame({"novelty": np.arange(6.0), "error": np.array(errors, dtype=float)})
    said = novelty.Novelty(usual, None).sentences("any method")
    assert verdict in said
    assert "not compared" in said


def test_novelty_needs_gears_to_be_left_out(tmp_path):
    assert novelty.novelty(gears_with(tmp_path, "a", 1.0, gears=3), None, pd.Series([1.0], [1])) is None
