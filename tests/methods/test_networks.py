"""Networks: what they are invariant to, what their scaling is, and that a seed is all they depend on."""

import numpy as np
import pytest
import torch

from learn.methods.networks import ARCHITECTURES, Architecture, Network, convolutional, perceptron

CHANNELS, POINTS, SIDE = 2, 32, 3
COLUMNS = CHANNELS * POINTS + SIDE


def rows(count: int = 40) -> np.ndarray:
    return np.random.default_rng(0).standard_normal((count, COLUMNS))


def network(residual: bool = False) -> Network:
    """Convolutional, in evaluation, with scaling that differs from column to column."""
    made = convolutional(CHANNELS, POINTS, COLUMNS, classes=4, width=8, residual=residual)
    made.set_scaling(rows() + np.linspace(0, 1, COLUMNS))
    return made.eval()


@torch.inference_mode()
def change_by_shift(shift: int, residual: bool, one_channel: bool = False) -> float:
    """Largest change of a logit when the deviations from the centre are turned by some points."""
    made, X = network(residual), torch.as_tensor(rows(), dtype=torch.float32)
    deviation = X - made.centre
    end = CHANNELS * POINTS
    turned = deviation[:, :end].unflatten(1, (CHANNELS, POINTS)).roll(shift, dims=2)
    if one_channel:
        turned[:, 1] = deviation[:, POINTS:end]
    moved = torch.cat([turned.flatten(1), deviation[:, end:]], dim=1) + made.centre
    return float((made(moved) - made(X)).abs().max())


@pytest.mark.parametrize("residual", [False, True])
def test_circular_shifts_of_all_channels_by_multiples_of_8_points_and_no_others_change_nothing(residual):
    assert all(change_by_shift(shift, residual) < 1e-5 for shift in (8, 16, 24, -8))
    assert all(change_by_shift(shift, residual) > 1e-3 for shift in (1, 2, 4, 12))
    assert change_by_shift(8, residual, one_channel=True) > 1e-3


def test_scaling_is_one_number_per_channel_and_the_quartiles_of_a_side_column():
    X = rows(4000) * np.concatenate([np.full(POINTS, 0.2), np.full(POINTS, 50.0), [1e-3, 1.0, 7.0]]) + 5.0
    X[0] += 1e6  # one absurd row must not matter
    for made in (convolutional(CHANNELS, POINTS, COLUMNS, 2), perceptron(COLUMNS, 2, channels=CHANNELS, points=POINTS)):
        made.set_scaling(X)
        scale = made.scale.numpy()
        assert len(np.unique(scale[:POINTS])) == len(np.unique(scale[POINTS : 2 * POINTS])) == 1
        np.testing.assert_allclose(scale[[0, POINTS, -3, -2, -1]], [0.2, 50.0, 1e-3, 1.0, 7.0], rtol=0.05)
        np.testing.assert_allclose(made.centre.numpy(), np.median(X, axis=0), rtol=1e-6)


def test_constant_columns_have_scale_1_and_rare_values_stay_finite():
    X = rows(100)
    X[:, -1] = 0.1
    X[:, -2] = 1 + 1e-15 * X[:, -2]  # rounding
    X[:, -3] = np.arange(100) < 5  # quartiles coincide
    X[:, :POINTS] = 0.0
    made = convolutional(CHANNELS, POINTS, COLUMNS, classes=2)
    made.set_scaling(X)
    np.testing.assert_array_equal(made.scale[[0, POINTS - 1, -1, -2]].numpy(), 1.0)
    assert made.scale[-3].item() == pytest.approx(X[:, -3].std())


def test_large_values_are_compressed_and_small_ones_are_not():
    made = perceptron(1, 2)
    made.body = torch.nn.Identity()
    small, large = made.embed(torch.tensor([[1e-3], [100.0]])).flatten().tolist()
    assert small == pytest.approx(1e-3, rel=1e-5)
    assert large == pytest.approx(np.arcsinh(100.0))


@pytest.mark.parametrize("kind", list(ARCHITECTURES))
def test_initial_weights_depend_on_the_seed_and_on_nothing_else(kind):
    architecture = Architecture(kind, {"channels": CHANNELS, "points": POINTS})
    torch.manual_seed(1)
    state = torch.get_rng_state()
    columns = CHANNELS * POINTS
    first = architecture.network(columns, 3, seed=5).state_dict()
    assert torch.equal(torch.get_rng_state(), state)
    torch.manual_seed(2)
    second, other = (architecture.network(columns, 3, seed=seed).state_dict() for seed in (5, 6))
    assert all(torch.equal(first[name], second[name]) for name in first)
    assert not torch.equal(first["head.weight"], other["head.weight"])


def test_features_have_separate_scales_and_any_number():
    X = np.random.default_rng(0).standard_normal((200, 13)) * np.logspace(-3, 3, 13)
    for network in (
        convolutional(1, 12, 13, 2, periodic=False),
        perceptron(13, 2, channels=1, points=12, periodic=False),
        perceptron(13, 2),
        convolutional(1, 13, 13, 2, periodic=False),
    ):
        network.set_scaling(X)
        np.testing.assert_allclose(network.scale.numpy(), np.logspace(-3, 3, 13), rtol=0.5)
        assert network(torch.as_tensor(X, dtype=torch.float32)).shape == (200, 2)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: convolutional(2, 30, 80, classes=3), r"2 channels of 30 points, needs .* multiple of 8"),
        (lambda: convolutional(0, 0, 8, classes=3), "without a signal take the perceptron"),
        (lambda: convolutional(2, 32, 50, classes=3), "50 columns, fewer than the 64"),
        (lambda: perceptron(4, 2, dropout=1.0), "dropout of the perceptron is 1"),
        (lambda: Architecture("transformer", {}), "'transformer' of the architectures; choose from perceptron, conv"),
        (lambda: perceptron(5, 2).set_scaling(np.zeros((3, 4))), "rows have 4 columns, the network was made for 5"),
    ],
)
def test_impossible_networks_are_refused_with_the_remedy(make, message):
    with pytest.raises(ValueError, match=message):
        make()
