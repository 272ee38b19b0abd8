"""Exported methods under sanitizers and on emulated microcontrollers: the same answers to good and to bad windows."""

import numpy as np
import pytest
from embedded_fixtures import OPERATION, SELECTION, noisy, of_gear, trained

from learn.embedded.export import export_c
from learn.embedded.machines import CORTEX_M4, CORTEX_M7, HOST, HOST_SANITIZED, build, missing
from learn.embedded.running import decide
from learn.inputs.harmonics import Harmonics
from learn.inputs.signals import Signals
from learn.methods.classical import multi_layer_perceptron
from learn.methods.neural import convolutional_network
from learn.methods.strong import extra_trees, logistic_regression

METHODS = {
    "regression": (Harmonics("harmonics", 6), logistic_regression(), "int16"),
    "trees": (Harmonics("harmonics", 6), extra_trees(20), "int16"),
    "trees in single precision": (SELECTION, extra_trees(20), "float"),
    "perceptron": (SELECTION, multi_layer_perceptron(iterations=30), "float"),
    "convolutional": (
        Signals("residual", points=16, orders=6),
        convolutional_network(5, 16, width=4, epochs=3),
        "int8",
    ),
}
SPOILT = (np.nan, np.inf, -np.inf, 1e38, -1e38, 2.0, 1.9999999)
OPERATIONS = (np.nan, np.inf, 0.0, -1.0, 1e-38, 1.5, 1e9)


@pytest.fixture(scope="module")
def data():
    return noisy()


def windows(samples):
    """Every recording as it is; then one with spoilt samples, in every gauge, and with spoilt operations."""
    signals, table = samples.signals, samples.table[OPERATION].to_numpy(float)
    bad, operations = [], []
    for value in SPOILT:
        for gauge in range(5):
            bad.append(signals[0].copy())
            bad[-1][gauge, 100::200] = value
            operations.append(table[0])
    for column in range(4):
        for value in OPERATIONS:
            bad.append(signals[0])
            operations.append(table[0].copy())
            operations[-1][column] = value
    bad += [np.zeros_like(signals[0]), np.full_like(signals[0], 1.5)]
    operations += [table[0], table[0]]
    return np.concatenate([signals, bad]), np.concatenate([table, operations])


@pytest.mark.parametrize("name", METHODS)
def test_every_machine_says_the_same_of_good_and_bad_windows(data, name, tmp_path):
    representation, model, numbers = METHODS[name]
    model, _ = trained(data, representation, model)
    gear = of_gear(data)
    export_c(model, representation, gear.references, tmp_path / "c", numbers=numbers)
    signals, operations = windows(gear.samples)
    there = [machine for machine in (HOST, HOST_SANITIZED, CORTEX_M4, CORTEX_M7) if not missing(machine)]
    if len(there) < 2:
        pytest.skip("needs gcc, and scripts/install_arm.sh for microcontrollers")
    first, *others = (
        decide(build(tmp_path / "c", machine, tmp_path / machine.name), machine, signals, operations)
        for machine in there
    )
    good = len(gear.samples)
    assert (first.results[:good] >= 0).all()
    assert (first.results[good : good + 6 * 5] < 0).all()  # but where a sample is just below the saturation
    for said in others:
        assert said.results.tolist() == first.results.tolist()
        np.testing.assert_allclose(said.probabilities, first.probabilities, atol=2e-4)
