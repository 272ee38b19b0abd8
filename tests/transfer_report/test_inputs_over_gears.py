"""Table, picture and JSON of the inputs over the number of training gears follow from the runs."""

import json

import numpy as np
import pandas as pd
import pytest

from learn.transfer_report import inputs_over_gears
from learn.transfer_report.inputs_over_gears import (
    over_gears,
    over_gears_figure,
    over_gears_json,
    over_gears_text,
    unusual_options,
)
from learn.transfer_report.seeds import averaged

# Input, network, training gears, filters or neurons, seed, error on gears never seen and in training [%]; newest first.
RUNS = [
    ("residual", "perceptron", 100, "256", "1", 18.0, 14.0),
    ("residual", "perceptron", 100, "256", "0", 16.0, 12.0),
    ("residual", "perceptron", 20, "256", "0", 19.0, 5.0),
    ("raw", "cnn", 500, "32", "0", 43.0, 35.0),
    ("residual", "perceptron", 100, "8", "0", 60.0, 60.0),
    ("template", "perceptron", 100, "256", "0", 21.0, 17.0),
    ("harmonics", "perceptron", 100, "256", "0", 15.0, 12.0),
]


@pytest.fixture(scope="module")
def runs():
    columns = ["features", "classifier", "protocol.sources", "size", "seed", "error", "training"]
    frame = pd.DataFrame(RUNS, columns=columns).astype({"protocol.sources": str})
    for name, of in (("classifier.neurons", "perceptron"), ("classifier.width", "cnn")):
        frame[name] = frame["size"].where(frame["classifier"] == of)
    frame = frame.assign(train_score=100 - frame.pop("training"), test_score=100 - frame.pop("error"))
    frame = frame.drop(columns="size").assign(run_id=frame.index.astype(str))
    return averaged(frame.assign(**{"classifier.seed": frame["seed"], "training": "training-bench"}))


@pytest.fixture(scope="module")
def table(runs):
    specimens = pd.DataFrame(
        [(gear, "healthy", variant) for gear in range(6) for variant in range(2)], columns=["gear", "label", "variant"]
    )
    spread = np.linspace(-0.5, 0.5, len(specimens))
    errors = {str(key): specimens.assign(error=100 - score + spread) for key, score in runs["test_score"].items()}
    return over_gears(runs, errors)


def test_seeds_are_averaged_and_runs_with_other_options_stay_apart(table):
    found = table.set_index(["input", "method", "gears", "options"])
    assert len(found) == len(RUNS) - 2  # two seeds of one choice, and an input that is not in this comparison
    usual = found.loc[("residual", "perceptron", 100, "")]
    assert usual[["value", "training", "seeds"]].tolist() == pytest.approx([17.0, 13.0, 2])
    assert found.loc[("residual", "perceptron", 100, "classifier.neurons=8"), "value"] == pytest.approx(60.0)
    assert (found["low"] < found["value"]).all()
    assert (found["value"] < found["high"]).all()


def test_options_are_those_that_most_runs_of_a_network_with_as_many_gears_lack():
    runs = pd.DataFrame(
        {
            "classifier": ["cnn", "cnn", "cnn", "cnn", "cnn", "perceptron"],
            "protocol.sources": ["100", "100", "100", "500", "500", "100"],
            "training": ["training-bench"] * 3 + ["wide-bench", "training500-bench", "training-bench"],
            "classifier.steps": ["2000", "9000", "2000", "9000", "9000", "50"],
            "features.reference": [None, None, "False", "True", "True", None],
        }
    )
    assert list(unusual_options(runs)) == ["", "classifier.steps=9000", "", "", "training=training500-bench", ""]


def test_rows_are_inputs_and_gears_and_a_cell_has_both_errors(table):
    text = over_gears_text(table)
    assert list(text.index) == [
        ("raw", "500"),
        ("raw minus the healthy reference", "100"),
        ("residual", "20"),
        ("residual", "100"),
        ("residual, classifier.neurons=8", "100"),
    ]
    assert text.loc[("residual", "20"), "MLP"].endswith("; 5.0")
    assert text.loc[("residual", "20"), "MLP"].startswith("19.0")
    assert text.loc[("residual", "20"), "CNN"] == "-"


def test_json_has_the_number_of_gears_next_to_a_hundred_and_null_for_what_was_not_run(table):
    found = json.loads(json.dumps(over_gears_json(table)))
    assert found["residual"]["mlp"]["gears"] == 100
    assert found["residual"]["mlp"]["value"] == pytest.approx(17.0)
    assert found["raw"]["cnn"]["gears"] == 500
    assert found["raw"]["mlp"] is None
    nothing = over_gears_json(None)
    assert nothing.keys() == found.keys()
    assert not any(entry for of_input in nothing.values() for entry in of_input.values())


def test_every_point_lies_within_the_picture(table, monkeypatch):
    drawn = []
    monkeypatch.setattr(inputs_over_gears.style, "png", lambda picture: drawn.append(picture) or b"")
    over_gears_figure(table)
    (picture,) = drawn
    assert [axes.get_title(loc="left") or axes.get_title() for axes in picture.axes] == ["MLP", "CNN"]
    for axes in picture.axes:
        bottom, top = axes.get_ylim()
        assert bottom == 0
        for line in axes.get_lines():
            assert (np.asarray(line.get_ydata(), float) < top).all()
