"""The training loop depends on its seed only, trains the chosen parameters, and restores the state of PyTorch."""

import io

import numpy as np
import pytest
import torch

from learn.methods.networks import Network, convolutional
from learn.methods.training import Recipe, choose_device, train
from learn.methods.training_benchmark import measure

CHANNELS, POINTS, SIDE = 1, 16, 2
COLUMNS = CHANNELS * POINTS + SIDE


def task(count: int = 24) -> tuple[torch.Tensor, torch.Tensor]:
    rng = np.random.default_rng(0)
    y = np.arange(count) % 3
    X = rng.standard_normal((count, COLUMNS))
    X[np.arange(count), 4 * y] += 2.0
    return torch.as_tensor(X, dtype=torch.float32), torch.from_numpy(y)


def network() -> Network:
    return convolutional(CHANNELS, POINTS, COLUMNS, classes=3, width=4)


def trained(seed: int = 0, recipe: Recipe = Recipe(epochs=2, batch=8), **options: object) -> Network:  # noqa: B008
    made = network()
    train(made, *task(), recipe, seed, **options)
    return made


def state_bytes(made: Network) -> bytes:
    raw = io.BytesIO()
    torch.save(made.state_dict(), raw)
    return raw.getvalue()


def changed(made: Network) -> set[str]:
    """Names of the state that training has changed."""
    before = network().state_dict()
    return {name for name, value in made.state_dict().items() if not torch.equal(value, before[name])}


def test_the_seed_decides_every_byte():
    assert state_bytes(trained(3)) == state_bytes(trained(3))
    assert state_bytes(trained(3)) != state_bytes(trained(4))
    assert not any(module.training for module in trained().modules())


def test_one_thread_inside_whatever_the_number_outside_and_global_state_is_restored_even_after_a_failure():
    expected, state, threads = state_bytes(trained()), torch.get_rng_state(), torch.get_num_threads()
    torch.set_num_threads(3)
    try:
        seen = []
        made = trained(penalty=lambda made: seen.append(torch.get_num_threads()) or torch.zeros(()))
        assert state_bytes(made) == expected
        with pytest.raises(ZeroDivisionError):
            trained(penalty=lambda made: 1 / 0)
        assert set(seen) == {1}
        assert torch.get_num_threads() == 3
        assert torch.equal(torch.get_rng_state(), state)
    finally:
        torch.set_num_threads(threads)


def test_all_rows_are_seen_in_every_epoch_in_batches_of_one_size():
    made, (X, y) = network(), task(21)
    seen = []
    made.body.register_forward_pre_hook(lambda module, inputs: seen.append(inputs[0]))
    train(made, X, y, Recipe(epochs=2, batch=10), 0)
    assert [len(batch) for batch in seen] == [7] * 6
    for epoch in (seen[:3], seen[3:]):
        assert torch.equal(torch.cat(epoch).sort(dim=0).values, made.scaled(X).sort(dim=0).values)
    assert not torch.equal(torch.cat(seen[:3]), torch.cat(seen[3:]))
    train(made, X, y, Recipe(epochs=2, batch=10, steps=8), 0)
    assert len(seen) == 6 + 9  # whole epochs of 3 steps
    made, (X, y) = network(), task(6)  # fewer rows than a batch
    train(made, X, y, Recipe(epochs=60, batch=256), 0)
    with torch.inference_mode():
        assert torch.equal(made(X).argmax(dim=1), y)


def test_the_head_or_everything_learns_and_frozen_statistics_stay():
    statistics = {name for name in network().state_dict() if "running" in name or "num_batches" in name}
    weights = {name for name, _ in network().named_parameters()}
    assert len(statistics) == 9
    assert changed(trained(frozen_statistics=True)) == weights
    assert changed(trained()) == weights | statistics
    made = network()
    train(made, *task(), Recipe(2, 8), 0, parameters=made.head.parameters(), frozen_statistics=True)
    assert changed(made) == {"head.weight", "head.bias"}
    assert all(weight.grad is None for weight in made.body.parameters())
    assert all(weight.requires_grad for weight in made.parameters())


def test_a_penalty_holds_the_weights_back():
    start = {name: value.clone() for name, value in network().named_parameters()}

    def distance(made: Network) -> torch.Tensor:
        return torch.stack([(value - start[name]).square().sum() for name, value in made.named_parameters()]).sum()

    free, held = (distance(trained(penalty=p)).item() for p in (None, lambda made: 100 * distance(made)))
    assert held < 0.2 * free


def test_divergence_empty_data_and_recipes_out_of_bounds_are_refused():
    with pytest.raises(ValueError, match=r"loss of .*: lower the rate, which is 10"):
        trained(penalty=lambda made: made.head.weight.square().sum() * float("inf"), recipe=Recipe(1, 8, rate=10.0))
    X, y = task()
    with pytest.raises(ValueError, match="0 rows to train on"):
        train(network(), X[:0], y[:0], Recipe(), 0)
    for option, value in (("epochs", 0), ("batch", 1), ("rate", 0.0), ("decay", -1.0)):
        with pytest.raises(ValueError, match=f"{option} of the recipe is {value}"):
            Recipe(**{option: value})


def test_devices():
    assert choose_device("cpu").type == "cpu"
    assert choose_device("auto").type == ("cuda" if torch.cuda.is_available() else "cpu")
    with pytest.raises(ValueError, match="unknown device 'gpu'; choose from auto, cpu, cuda"):
        choose_device("gpu")
    with pytest.raises(ValueError, match="does not find device 'meta'"):
        choose_device("meta")


def test_the_benchmark_measures_every_figure(monkeypatch):
    monkeypatch.setattr("learn.methods.training_benchmark.ROUNDS", 1)
    before = torch.get_num_threads()
    result = measure(recordings=24, channels=1, points=16, auxiliary=2)
    assert torch.get_num_threads() == before
    assert all(figure > 0 for figure in result.values())
    assert result["samples_per_second"] == pytest.approx(24 * 15 / result["seconds"])
