"""The public interface of learn gives what jobs give, by the same names, without Hydra and MLflow."""

from pathlib import Path

import pytest
from fabricated import recordings
from sklearn.dummy import DummyClassifier

import learn
from swgsim.storage import storage


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> learn.LearningSet:
    path = tmp_path_factory.mktemp("data") / "fabricated.h5"
    fabricated = recordings()
    storage.write(path, [fabricated], len(fabricated))
    return learn.load(path, features="selection_1")


def test_features_have_a_row_for_each_recording(data: learn.LearningSet) -> None:
    assert len(data.features) == len(data.table)


def test_scores_show_themselves(data: learn.LearningSet, tmp_path: Path) -> None:
    scores = learn.evaluate(data, "rf", "leave_one_gear_out", trees=5)
    assert list(scores.table().index) == ["1,2->3", "2,3->1", "1,3->2"]
    assert repr(scores).startswith("<Scores rf, leave one gear out: ")
    scores.save(tmp_path / "page.html")
    assert "data:image/png" in (tmp_path / "page.html").read_text()


def test_a_classifier_of_ones_own_is_judged(data: learn.LearningSet) -> None:
    assert "DummyClassifier" in repr(learn.evaluate(data, DummyClassifier))


def test_a_misspelt_name_lists_the_choices() -> None:
    with pytest.raises(ValueError, match=r"unknown classifier 'rff'; choose from .*rf"):
        learn.classifier("rff")
    with pytest.raises(ValueError, match="no data set"):
        learn.load("nothing.h5")
