"""The export job: what its configuration takes, what it leaves, and what it refuses."""

import logging
from pathlib import Path

import pytest
from embedded_fixtures import needs_compiler, noisy
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn.embedded import export_job as job
from swgsim.storage import storage

CONF = Path(__file__).parents[2] / "conf"

pytestmark = needs_compiler


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a data set, in which all tests keep their models."""
    folder = tmp_path_factory.mktemp("data")
    made = noisy()
    storage.write(folder / "small-bench.h5", [made], len(made))
    return folder


@pytest.fixture
def export(folder, tmp_path):
    def run(*overrides):
        places = [f"data={folder}", f"models={folder / 'models'}", f"out={tmp_path / 'out'}"]
        with initialize_config_dir(str(CONF), version_base="1.3"):
            config = compose("export", ["grid=small", *places, "features.orders=6", *overrides])
        job.run(OmegaConf.to_container(config, resolve=True))
        return tmp_path / "out"

    return run


def test_gears_differ_in_one_file_and_a_kept_model_is_taken(export, folder):
    first = {path.name: path.read_bytes() for path in export("exported_gear=1").iterdir()}
    assert {"swg.h", "model.h", "gear.c", "window.c"} <= set(first)
    (kept,) = (folder / "models").glob("*.skops")
    second = {path.name: path.read_bytes() for path in export("exported_gear=2", f"model={kept}").iterdir()}
    assert [name for name in first if first[name] != second[name]] == ["gear.c"]


def test_an_export_that_differs_from_its_original_is_a_warning(export, caplog, monkeypatch):
    for faithful, level in ((job.FAITHFUL, "INFO"), (100.1, "WARNING")):
        monkeypatch.setattr(job, "FAITHFUL", faithful)
        with caplog.at_level(logging.INFO):
            export("numbers=int16")
        assert "labels as in Python (0 without a decision)" in caplog.messages[-1]
        assert caplog.records[-1].levelname == level


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["exported_gear=9"], "unknown choice '9' of gears"),
        (["target=fpga"], "unknown choice 'fpga' of target; choose from c, onnx"),
        (["numbers=int4"], "unknown choice 'int4' of numbers"),
        (["model=absent.skops"], "no model absent.skops"),
        (["features=lines", "~features.orders"], "features=lines have no front end in C"),
    ],
    ids=lambda value: value if isinstance(value, str) else value[0],
)
def test_what_cannot_be_exported_is_named_and_nothing_is_left(export, tmp_path, overrides, message):
    with pytest.raises(ValueError, match=message):
        export(*overrides)
    assert not (tmp_path / "out").exists()


def test_a_folder_with_other_files_is_refused_before_training(export, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("mine")
    with pytest.raises(ValueError, match=r"holds thesis\.tex, which no export wrote"):
        export(f"models={tmp_path / 'models'}")
    assert not (tmp_path / "models").exists()
