"""Outputs of the fast twin are densities, and the loss has its minimum at Bayes' posterior."""

import numpy as np
import pandas as pd
import pytest
import torch

from learn.methods.fault_outputs import FaultOutputs

OUTPUTS = FaultOutputs({"reduced_damping": (0.7, 0.99), "tip_tooth_crack": (0.5, 1.0)})
COUNT = 4000


def facts(**columns: object) -> pd.DataFrame:
    return pd.DataFrame({"label": "tip_tooth_crack", "severity": np.nan, "position": np.nan, **columns})


def raw(**parts: tuple[float, ...]) -> torch.Tensor:
    """Outputs with logits of the three classes, and size and position of the tip crack."""
    sizes, positions = (0.0, 0.0, *parts["size"]), (0.0, 0.0, 0.0, *parts["position"])
    return torch.tensor([[*parts["logits"], *sizes, *positions]], dtype=torch.float64)


def test_targets_and_diagnosis_are_inverse() -> None:
    table = facts(severity=[0.5, 0.6, 1.0], position=[1.0, 3.0, 6.0])
    targets = OUTPUTS.targets(table)
    np.testing.assert_allclose(targets[:, 0], 2)
    np.testing.assert_allclose(targets[[0, 2], 1], [-1, 1])
    sure = [
        raw(logits=(0, 0, 9), size=(np.arctanh(min(max(size, -0.999), 0.999)), -7.0),
            position=(3 * np.cos(angle), 3 * np.sin(angle), 10.0))
        for size, angle in targets[:, 1:]
    ]  # fmt: skip
    found = OUTPUTS.diagnosis(torch.cat(sure))
    np.testing.assert_allclose(found["severity"], table["severity"], rtol=2e-3)
    np.testing.assert_allclose(found["position"], table["position"], atol=1e-9)
    assert (found["severity_low"] < found["severity_high"]).all()
    assert (found["position_deviation"] < 0.01).all()


def test_what_a_class_has_not_is_missing() -> None:
    healthy = raw(logits=(9, 0, 0), size=(0, 0), position=(1, 0, 0))
    damped = raw(logits=(0, 9, 0), size=(0, 0), position=(1, 0, 0))
    found = OUTPUTS.diagnosis(torch.cat([healthy, damped]))
    assert found.iloc[0, 3:].isna().all()
    assert found.iloc[1, 3:6].notna().all()
    assert found.iloc[1, 6:].isna().all()


@pytest.mark.parametrize("log_deviation", [-2.0, 0.0, 2.0])
@pytest.mark.parametrize("mean", [-1.5, 0.3])
def test_size_and_position_are_densities(mean: float, log_deviation: float) -> None:
    """The integral of exp(-loss) over what may be true does not depend on the outputs."""
    outputs = raw(logits=(0, 0, 0), size=(mean, log_deviation), position=(0.3, -0.4, -log_deviation)).double()
    size, position = np.linspace(-1, 1, COUNT), np.linspace(0, 2 * np.pi, COUNT)
    nowhere = np.full(COUNT, np.nan)

    def integral(sizes: np.ndarray, positions: np.ndarray, over: np.ndarray) -> float:
        targets = torch.from_numpy(np.column_stack([np.full(COUNT, 2.0), sizes, positions]))
        losses = [float(OUTPUTS.loss(outputs, each[None])) for each in targets[::20]]
        return float(np.trapezoid(np.exp(-np.array(losses)), over[::20]))

    logits = 1 / 3  # the probability of the class is a factor
    assert integral(size, nowhere, size) == pytest.approx(logits * np.sqrt(2 * np.pi), rel=0.02)
    assert integral(nowhere, position, position) == pytest.approx(logits * 2 * np.pi, rel=0.02)


def test_no_outputs_have_a_lower_loss_than_the_posterior() -> None:
    """Of angles that are drawn from a distribution of von Mises, the loss finds direction and concentration."""
    rng = np.random.default_rng(0)
    angles = rng.vonmises(1.0, 4.0, COUNT)
    targets = torch.from_numpy(np.column_stack([np.full(COUNT, 2.0), np.full(COUNT, np.nan), angles]))

    def loss(direction: float, concentration: float) -> float:
        placed = (np.cos(direction), np.sin(direction), np.log(concentration))
        return float(OUTPUTS.loss(raw(logits=(0, 0, 0), size=(0, 0), position=placed).expand(COUNT, -1), targets))

    best = loss(1.0, 4.0)
    for other in ((0.8, 4.0), (1.2, 4.0), (1.0, 2.0), (1.0, 8.0)):
        assert loss(*other) > best
