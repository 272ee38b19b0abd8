"""Transfer improves the score on a shifted target, keeps the source model, and depends on its seed only."""

import hashlib
from dataclasses import replace

import numpy as np
import pytest
import torch
from sklearn.ensemble import RandomForestClassifier
from sklearn.linear_model import LogisticRegression

from learn.adaptation.adversarial import DomainAdversarial, reverse_gradient
from learn.adaptation.alignment import BatchNormAdaptation, Coral, align
from learn.adaptation.fine_tuning import L2SP, FineTuning, LinearProbe, ProbeThenFineTuning, Replay
from learn.adaptation.prototypes import Prototypes
from learn.adaptation.retraining import FromScratch
from learn.adaptation.transfer import Adaptation, FittedClassifier, Labelled
from learn.methods.neural import convolutional_network, neural_perceptron

NAMES = np.array(["a", "b", "c"])
COLUMNS = 16
NO_SHOTS, NO_RECORDINGS = Labelled(np.empty((0, COLUMNS)), np.empty(0, dtype=str)), np.empty((0, COLUMNS))
WITH_SHOTS = [LinearProbe(), FineTuning(), Replay(), L2SP(), ProbeThenFineTuning(), Prototypes()]
WITHOUT_LABELS = [Coral(), BatchNormAdaptation(), DomainAdversarial(epochs=1)]
SHORT = [
    LinearProbe(5), Replay(5), L2SP(5), ProbeThenFineTuning(LinearProbe(2), FineTuning(2)),
    Prototypes(), FromScratch(10), *WITHOUT_LABELS,
]  # fmt: skip


def rows(number, seed, angle=0.0, shift=0.0):
    """Three clouds on a circle in the plane of the first two of 16 columns, which the target turns and moves."""
    rng = np.random.default_rng(seed)
    numbers = np.arange(number) % 3
    direction = 2 * np.pi * numbers / 3 + angle
    X = 0.7 * rng.standard_normal((number, COLUMNS))
    X[:, :2] += 3 * np.column_stack([np.cos(direction), np.sin(direction)]) + shift
    return Labelled(X, NAMES[numbers])


SOURCE, SHOTS, TARGET = rows(300, 0), rows(30, 1, 0.9, 0.5), rows(600, 2, 0.9, 0.5)


@pytest.fixture(scope="module")
def perceptron():
    return neural_perceptron(neurons=32, dropout=0.3, epochs=10, batch=32, rate=3e-3, decay=0.01, device="cpu").fit(
        *SOURCE
    )


@pytest.fixture(scope="module")
def convolutional():
    return convolutional_network(channels=1, points=8, width=8, epochs=5, batch=32, device="cpu").fit(*SOURCE)


def adapted(method, source, shots=NO_SHOTS, unlabelled=NO_RECORDINGS, seed=0):
    assert isinstance(method, Adaptation)
    result = method.adapt(source, SOURCE, shots, unlabelled, seed)
    assert isinstance(result, FittedClassifier)
    return result


def score(model, target=TARGET):
    return np.mean(model.predict(target.X) == target.y)


def digest(model):
    sha = hashlib.sha256()
    for name, value in model.network_.state_dict().items():
        sha.update(name.encode() + value.numpy().tobytes())
    return sha.hexdigest()


@pytest.mark.parametrize("method", WITH_SHOTS, ids=str)
def test_shots_of_a_turned_target_help(method, perceptron):
    model = adapted(method, perceptron, SHOTS)
    assert score(model) > score(perceptron) + 0.05
    assert np.allclose(model.predict_proba(TARGET.X).sum(axis=1), 1)


@pytest.mark.parametrize("method", SHORT, ids=str)
def test_source_and_rows_stay_and_the_seed_decides(method, convolutional):
    given = [SOURCE.X, SHOTS.X, TARGET.X]
    before, copies = digest(convolutional), [X.copy() for X in given]
    first, second = (adapted(method, convolutional, SHOTS, TARGET.X).predict_proba(TARGET.X) for _ in range(2))
    assert first.tobytes() == second.tobytes()
    assert digest(convolutional) == before
    assert not convolutional.network_.training
    assert all(np.array_equal(X, copy) for X, copy in zip(given, copies, strict=True))


@pytest.mark.parametrize(
    "method", [LinearProbe(0), Replay(0), L2SP(0), ProbeThenFineTuning(LinearProbe(0), FineTuning(0))], ids=str
)
def test_no_step_is_the_source_model(method, perceptron):
    assert digest(adapted(method, perceptron, SHOTS)) == digest(perceptron)


def test_all_labels_and_no_transfer_is_training_on_the_target(perceptron):
    for source, alone in (
        (perceptron, replace(perceptron, seed=3)),
        (RandomForestClassifier(5, random_state=0).fit(*SOURCE), RandomForestClassifier(5, random_state=3)),
    ):
        expected = alone.fit(*TARGET).predict_proba(TARGET.X)
        assert (
            adapted(FromScratch(steps=1), source, TARGET, seed=3).predict_proba(TARGET.X).tobytes()
            == expected.tobytes()
        )


def changed(source, model):
    old, new = source.network_.state_dict(), model.network_.state_dict()
    return {name for name in old if not torch.equal(old[name], new[name])}


def test_a_probe_changes_the_head_and_fine_tuning_everything_but_statistics_and_scaling(convolutional):
    state = convolutional.network_.state_dict()
    fixed = {name for name in state if "running" in name or "num_batches" in name} | {"centre", "scale"}
    assert any("running_var" in name for name in fixed)
    assert changed(convolutional, adapted(LinearProbe(5), convolutional, SHOTS)) == {"head.weight", "head.bias"}
    assert changed(convolutional, adapted(FineTuning(5), convolutional, SHOTS)) == set(state) - fixed


def test_a_strong_pull_keeps_the_source_model(perceptron):
    expected = perceptron.predict_proba(TARGET.X)
    free, held = (adapted(L2SP(strength=s), perceptron, SHOTS).predict_proba(TARGET.X) for s in (0, 1e6))
    assert np.abs(free - expected).max() > 0.5
    np.testing.assert_allclose(held, expected, atol=0.01)
    assert digest(adapted(L2SP(strength=0), perceptron, SHOTS)) == digest(adapted(FineTuning(), perceptron, SHOTS))


def test_replay_forgets_less(perceptron):
    plain, replayed = (adapted(method, perceptron, SHOTS) for method in (FineTuning(), Replay()))
    assert score(replayed, SOURCE) > score(plain, SOURCE)


def test_prototypes_lie_between_the_means_of_source_and_shots():
    source = LogisticRegression().fit(*SOURCE)
    model = adapted(Prototypes(strength=5), source, SHOTS)
    a = [side.X[side.y == "a"] for side in (SOURCE, SHOTS)]
    mean = (5 * a[0].mean(axis=0) + a[1].sum(axis=0)) / (5 + len(a[1]))
    np.testing.assert_allclose(model.prototypes[0], (mean - SOURCE.X.mean(axis=0)) / SOURCE.X.std(axis=0))
    assert score(adapted(Prototypes(strength=1e9), source, SHOTS)) < score(model)


def test_coral_undoes_a_change_of_covariance():
    plain = rows(3000, 4)
    target = Labelled(plain.X * np.repeat([0.3, 30], [2, COLUMNS - 2]), plain.y)  # along the axes of the covariance
    source = LogisticRegression().fit(*SOURCE)
    assert score(source, target) < 0.9
    assert score(adapted(Coral(shrinkage=1e-6), source, unlabelled=target.X), target) > 0.99


def test_aligned_rows_have_the_mean_and_covariance_of_the_target():
    aligned = align(SOURCE.X, TARGET.X, 1e-9)
    np.testing.assert_allclose(aligned.mean(axis=0), TARGET.X.mean(axis=0), atol=1e-9)
    np.testing.assert_allclose(np.cov(aligned.T, bias=True), np.cov(TARGET.X.T, bias=True), atol=1e-6)


def test_batch_statistics_are_those_of_the_target(convolutional):
    network = adapted(BatchNormAdaptation(), convolutional, unlabelled=TARGET.X).network_
    scaled = torch.asinh((torch.from_numpy(TARGET.X).float() - network.centre) / network.scale)
    with torch.no_grad():
        response = network.body.blocks[0](scaled[:, None, :8])
    torch.testing.assert_close(network.body.blocks[1].running_mean, response.mean((0, 2)), atol=1e-5, rtol=1e-4)
    assert changed(convolutional, adapted(BatchNormAdaptation(0), convolutional, unlabelled=TARGET.X)) <= {
        f"body.blocks.{block}.num_batches_tracked" for block in (1, 4, 7)
    }


def test_each_layer_is_measured_behind_the_mixed_statistics_of_the_layers_before_it(convolutional):
    mixing = 0.3
    layers = [
        [module for module in model.network_.modules() if isinstance(module, torch.nn.BatchNorm1d)]
        for model in (convolutional, adapted(BatchNormAdaptation(mixing), convolutional, unlabelled=TARGET.X))
    ]
    mixed = adapted(BatchNormAdaptation(mixing), convolutional, unlabelled=TARGET.X).network_
    heard = {}
    for number, layer in enumerate(m for m in mixed.modules() if isinstance(m, torch.nn.BatchNorm1d)):
        layer.register_forward_pre_hook(lambda _, given, number=number: heard.update({number: given[0]}))
    with torch.no_grad():
        mixed.embed(torch.from_numpy(TARGET.X).float())
    for number, (before, after) in enumerate(zip(*layers, strict=True)):
        wanted = (1 - mixing) * before.running_mean + mixing * heard[number].mean((0, 2))
        torch.testing.assert_close(after.running_mean, wanted, atol=1e-5, rtol=1e-4)
        assert not after.training
        assert after.momentum == before.momentum


def test_reversed_gradients():
    features = torch.tensor([[1.0, -2.0]], requires_grad=True)
    reversed_ = reverse_gradient(features, 0.3)
    reversed_.sum().backward()
    torch.testing.assert_close(reversed_, features)
    torch.testing.assert_close(features.grad, torch.full((1, 2), -0.3))


def test_adversarial_features_hide_the_domain(perceptron):
    target = rows(600, 2)
    target.X[:, 5] += 3  # tells the domain and no class
    apart = []
    for weight in (0.0, 1.0):
        method = DomainAdversarial(epochs=15, batch=32, weight=weight)
        network = adapted(method, perceptron, unlabelled=target.X).network_
        with torch.no_grad():
            of = [network.embed(torch.from_numpy(X).float()).numpy() for X in (SOURCE.X, target.X)]
        y = np.repeat([0, 1], [len(each) for each in of])
        apart.append(LogisticRegression(max_iter=5000).fit(np.concatenate(of), y).score(np.concatenate(of), y))
    assert apart[1] < apart[0] - 0.05


@pytest.mark.parametrize("method", [*WITHOUT_LABELS, *WITH_SHOTS, FromScratch()], ids=str)
def test_missing_recordings_and_shots_are_named(method, convolutional):
    what = "unlabelled" if method in WITHOUT_LABELS else "shots"
    rows = {"shots": SHOTS} if what == "unlabelled" else {"unlabelled": TARGET.X}
    with pytest.raises(ValueError, match=f"received 0 rows of {what} and needs at least 1"):
        adapted(method, convolutional, **rows)


def test_wrong_values_and_models_are_named(perceptron):
    with pytest.raises(ValueError, match=r"strength of L2-SP is -1"):
        L2SP(strength=-1)
    with pytest.raises(ValueError, match=r"rate of the linear probe is 0"):
        LinearProbe(rate=0)
    with pytest.raises(ValueError, match=r"LogisticRegression has no network to adapt"):
        adapted(FineTuning(), LogisticRegression().fit(*SOURCE), SHOTS)
    with pytest.raises(ValueError, match=r"the perceptron network has no batch normalisation"):
        adapted(BatchNormAdaptation(), perceptron, unlabelled=TARGET.X)
    with pytest.raises(ValueError, match=r"Own cannot be trained anew: derive it from sklearn.base.BaseEstimator"):
        adapted(FromScratch(), type("Own", (), {})(), SHOTS)
