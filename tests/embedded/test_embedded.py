"""The exported C makes the features and the decisions of its original, and none where the window is bad."""

from copy import deepcopy

import numpy as np
import pytest
from embedded_fixtures import SELECTION, compiled, driven, driven_signals, needs_compiler, noisy, of_gear, trained
from fabricated import recordings

from learn.embedded.export import export_c
from learn.inputs.harmonics import Harmonics
from learn.inputs.lines import ResidualLines
from learn.inputs.signals import Signals
from learn.methods.classical import multi_layer_perceptron
from learn.methods.neural import convolutional_network, neural_perceptron
from learn.methods.strong import extra_trees, logistic_regression

HARMONICS = Harmonics("harmonics", 6)
RESIDUAL = Signals("residual", points=16, orders=6)
REGRESSION = logistic_regression(iterations=30)
CONVOLUTIONAL = convolutional_network(5, 16, width=4, epochs=30)
REPRESENTATIONS = (SELECTION, HARMONICS, RESIDUAL, Harmonics("harmonics", 5, efficiency=False, operating_point=False))

pytestmark = needs_compiler


@pytest.fixture(scope="module")
def data():
    return noisy()


@pytest.fixture(scope="module")
def fitted(data):
    """A trained copy of a model and the features of the exported gear; each is trained once."""
    kept = {}

    def once(representation, model):
        key = representation, id(model)
        if key not in kept:
            kept[key] = trained(data, representation, deepcopy(model))
        return kept[key]

    return once


@pytest.mark.parametrize("representation", REPRESENTATIONS, ids=lambda each: type(each).__name__)
def test_features_are_those_of_python(data, fitted, representation, tmp_path):
    model, expected = fitted(representation, REGRESSION)
    gear = of_gear(data)
    export_c(model, representation, gear.references, tmp_path / "c")
    rows, _, said = driven(compiled(tmp_path / "c"), gear.samples, expected.shape[1])
    assert (said >= 0).all()
    scatter = np.maximum(expected.std(axis=0), 1e-6)
    assert np.abs((rows - expected) / scatter).max() < 2e-3


@pytest.mark.parametrize(
    ("representation", "model", "numbers", "tolerance"),
    [
        (HARMONICS, REGRESSION, "float", 1e-3),
        (HARMONICS, REGRESSION, "int8", 0.05),
        (SELECTION, multi_layer_perceptron(iterations=30), "float", 1e-3),
        (HARMONICS, neural_perceptron(neurons=16, epochs=3), "int16", 1e-3),
        (RESIDUAL, CONVOLUTIONAL, "float", 1e-3),
        (RESIDUAL, CONVOLUTIONAL, "int8", 0.05),
        (SELECTION, extra_trees(20), "float", 1e-3),
        (HARMONICS, extra_trees(20), "int16", 0.15),
    ],
    ids=lambda each: getattr(each, "name", type(each).__name__) if not isinstance(each, str) else each,
)
def test_decisions_are_those_of_python(data, fitted, representation, model, numbers, tolerance, tmp_path):
    model, features = fitted(representation, model)
    gear = of_gear(data)
    export_c(model, representation, gear.references, tmp_path / "c", numbers=numbers)
    _, p, said = driven(compiled(tmp_path / "c"), gear.samples, features.shape[1])
    expected = model.predict_proba(features)
    assert np.abs(p - expected).max() < tolerance
    first, second = np.sort(expected, axis=1)[:, :-3:-1].T
    clear = first - second > 2 * tolerance
    assert clear.mean() > 0.5
    assert np.array_equal(said[clear], expected.argmax(axis=1)[clear])


COLUMNS = len(HARMONICS.learning_set([recordings(gears=1, variants=1)]).names)
NOT_COMMISSIONED, NOT_STEADY, NOT_A_NUMBER, SATURATED, DEAD = -1, -4, -8, -16, -32


@pytest.fixture(scope="module")
def library(data, fitted, tmp_path_factory):
    folder = tmp_path_factory.mktemp("exported") / "c"
    model, _ = fitted(HARMONICS, REGRESSION)
    export_c(model, HARMONICS, of_gear(data).references, folder, saturation=1.5)
    return compiled(folder)


@pytest.fixture(scope="module")
def sample(data):
    """One recording of the exported gear, at the higher speed."""
    samples = of_gear(data).samples
    return samples.where(np.flatnonzero(samples.table["n_in_rpm"] == 4000.0)[:1])


@pytest.mark.parametrize(
    ("value", "answer"),
    [(np.nan, NOT_A_NUMBER), (np.inf, NOT_A_NUMBER + SATURATED), (1.5, SATURATED), (-1.6, SATURATED)],
)
@pytest.mark.parametrize("gauge", range(5))
@pytest.mark.parametrize("time", [0, 300, 599])
def test_one_bad_sample_is_no_class(library, sample, value, answer, gauge, time):
    assert driven(library, sample, COLUMNS)[2][0] >= 0
    bad = sample.signals.copy()
    bad[0, gauge, time] = value
    _, p, said = driven_signals(library, bad, sample.table, COLUMNS)
    assert said[0] == answer
    assert not p.any()


@pytest.mark.parametrize("gauge", range(5))
@pytest.mark.parametrize(
    ("first", "last", "value"),
    [(0, 600, 0.0), (0, 600, 0.2), (100, 600, 0.1), (0, 150, 0.1), (1, 600, 0.0)],
    ids=["at 0", "constant", "from a sixth on", "in the first quarter", "but for one sample"],
)
def test_a_dead_gauge_is_no_class(data, library, gauge, first, last, value):
    samples = of_gear(data).samples
    dead = samples.signals.copy()
    dead[:, gauge, first:last] = value
    assert (driven_signals(library, dead, samples.table, COLUMNS)[2] == DEAD).all()


@pytest.mark.parametrize(
    ("facts", "answer"),
    [
        ({"efficiency": 0.0}, NOT_A_NUMBER),
        ({"efficiency": np.nan}, NOT_A_NUMBER),
        ({"efficiency": -0.7}, NOT_A_NUMBER),
        ({"efficiency": 71.0}, NOT_A_NUMBER),
        ({"temperature_c": 298.0}, NOT_A_NUMBER),
        ({"n_in_rpm": 3000.0}, NOT_COMMISSIONED),
        ({"T_out_nm": np.nan}, NOT_COMMISSIONED),
    ],
)
def test_a_bad_operation_is_no_class(library, sample, facts, answer):
    assert driven(library, sample, COLUMNS, **facts)[2][0] == answer


def test_a_temperature_that_is_not_measured_is_that_of_the_reference(library, sample):
    warm, unknown = (driven(library, sample, COLUMNS, temperature_c=given)[0][0] for given in (90.0, np.nan))
    (changed,) = np.flatnonzero(warm != unknown)
    assert unknown[changed] == 0
    assert warm[changed] == pytest.approx(90.0 - 25.5)  # the mean of its two references


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"representation": ResidualLines("lines", 6)}, "features=lines have no front end in C: take"),
        ({"representation": Signals("residual", points=50, orders=6)}, "signals of 50 points have no front end"),
        ({"saturation": 0.1}, "saturation of the amplifiers is"),
        ({"saturation": 100}, "saturation of the amplifiers is 100"),
        ({"references": "all"}, "references of gears 1, 2, 3 found"),
        ({"model": HARMONICS}, "Harmonics has no layers"),
        ({"file": "main.c"}, r"c holds main\.c, which no export wrote"),
    ],
    ids=str,
)
def test_what_cannot_be_exported_is_refused_and_an_earlier_export_stays(data, fitted, changes, message, tmp_path):
    choices = {"model": fitted(HARMONICS, REGRESSION)[0], "representation": HARMONICS, "folder": tmp_path / "c"}
    choices |= {"references": of_gear(data).references}
    for _ in range(2):  # the second replaces the first
        export_c(**choices)
    changes = dict(changes) | ({"references": data.references} if "references" in changes else {})
    if "file" in changes:
        (tmp_path / "c" / changes.pop("file")).write_text("mine")
    before = {path.name: path.read_bytes() for path in (tmp_path / "c").iterdir()}
    with pytest.raises(ValueError, match=message):
        export_c(**{**choices, **changes})
    assert {path.name: path.read_bytes() for path in (tmp_path / "c").iterdir()} == before
    assert [path.name for path in tmp_path.iterdir()] == ["c"]


def test_a_file_is_no_folder_to_export_to(data, fitted, tmp_path):
    (tmp_path / "main.c").write_text("mine")
    with pytest.raises(ValueError, match=r"main\.c is a file"):
        export_c(fitted(HARMONICS, REGRESSION)[0], HARMONICS, of_gear(data).references, tmp_path / "main.c")
