"""Table, picture and JSON of the inputs over the number of training gears follow from the runs."""

import json

import numpy as np
import pandas as pd
import pytest

from learn.transfer_report import inputs_over_gears
from learn.transfer_report.inputs_over_gears import over_gears, over_gears_figure, over_gears_json, over_gears_text

# Input, network, training gears, error on gears never seen and in training [%]; the newest first.
RUNS = [
    ("residual", "perceptron", 100, 17.0, 13.0),
    ("residual", "perceptron", 20, 19.0, 5.0),
    ("raw", "cnn", 500, 43.0, 35.0),
    ("residual", "perceptron", 100, 90.0, 90.0),
]


@pytest.fixture(scope="module")
def table():
    runs = pd.DataFrame(
        {
            "features": [each[0] for each in RUNS],
            "classifier": [each[1] for each in RUNS],
            "protocol.sources": [str(each[2]) for each in RUNS],
            "train_score": [100 - each[4] for each in RUNS],
            "seeds": 1,
        }
    )
    specimens = pd.DataFrame(
        [(gear, "healthy", variant) for gear in range(6) for variant in range(2)], columns=["gear", "label", "variant"]
    )
    spread = np.linspace(-0.5, 0.5, len(specimens))
    return over_gears(runs, {str(n): specimens.assign(error=each[3] + spread) for n, each in enumerate(RUNS)})


def test_the_newest_run_of_each_input_network_and_number_counts(table):
    found = table.set_index(["input", "method", "gears"])
    assert len(found) == 3
    assert found.loc[("residual", "perceptron", 100), "value"] == pytest.approx(17.0)
    assert found.loc[("residual", "perceptron", 100), "training"] == pytest.approx(13.0)
    assert (found["low"] < found["value"]).all()
    assert (found["value"] < found["high"]).all()


def test_rows_are_inputs_and_gears_and_a_cell_has_both_errors(table):
    text = over_gears_text(table)
    assert list(text.index) == [("raw", "500"), ("residual", "20"), ("residual", "100")]
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
