"""The network on units takes their recordings as a set, learns what one of them shows, and comes back from its file."""

import numpy as np
import pytest
import torch

from learn.methods.neural import load, save, set_network
from learn.methods.recording_sets import RecordingSets

FEATURES, RECORDINGS = 3, 4
CLASSES = np.array(["healthy", "root", "tip"])


def task(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Noise; the class is the height of a feature at any one of the recordings."""
    rng = np.random.default_rng(seed)
    number, at = np.arange(count) % 3, rng.integers(RECORDINGS, size=count)
    X = rng.standard_normal((count, FEATURES, RECORDINGS))
    X[np.arange(count), np.maximum(number - 1, 0), at] += np.where(number > 0, 10.0, 0.0)
    return X.reshape(count, -1), CLASSES[number]


@torch.inference_mode()
def test_recordings_are_a_set_until_their_points_are_learned():
    body = RecordingSets(FEATURES, RECORDINGS, neurons=8, dropout=0.2).eval()
    X = torch.as_tensor(task(20, 0)[0], dtype=torch.float32)
    turned = X.unflatten(1, (FEATURES, RECORDINGS)).roll(1, dims=2).flatten(1)
    torch.testing.assert_close(body(X), body(turned))
    body.at_point[0] += 1.0
    assert (body(X) - body(turned)).abs().max() > 1e-3


def test_what_one_recording_shows_is_learned_and_kept(tmp_path):
    model = set_network(FEATURES, RECORDINGS, neurons=16, rate=1e-2, batch=32, device="cpu").fit(*task(600, 0))
    X, truth = task(300, 1)
    assert np.mean(model.predict(X) == truth) > 0.95
    save(model, tmp_path / "model.pt")
    np.testing.assert_array_equal(load(tmp_path / "model.pt", "cpu").predict_proba(X), model.predict_proba(X))


def test_rows_of_recordings_are_refused():
    with pytest.raises(ValueError, match="take rows=unit features=harmonics"):
        set_network(0, 0, periodic=True)
    with pytest.raises(ValueError, match="12 columns for 2 features of 4 recordings"):
        set_network(2, RECORDINGS, device="cpu").fit(*task(30, 0))
