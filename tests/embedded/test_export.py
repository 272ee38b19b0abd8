"""scripts/export.py: what its command line takes, what it leaves, and what it refuses."""

import logging
import subprocess
import sys
from pathlib import Path

import pytest
from embedded_fixtures import needs_compiler, noisy
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn.embedded import export_job as job
from swgsim.storage import storage

ROOT = Path(__file__).parents[2]

pytestmark = needs_compiler


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    made = noisy()
    storage.write(folder / "small-bench.h5", [made], len(made))
    return folder


@pytest.fixture
def export(data, tmp_path):
    def run(*overrides):
        where = ["grid=small", f"data={data}", f"models={tmp_path / 'models'}", f"out={tmp_path / 'out'}"]
        with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
            job.run(OmegaConf.to_container(compose("export", [*where, "features.orders=6", *overrides]), resolve=True))
        return tmp_path / "out"

    return run


def test_the_command_line_chooses_the_gear(data, tmp_path):
    command = [
        sys.executable,
        "scripts/export.py",
        "grid=small",
        "features.orders=6",
        "exported_gear=2",
        f"data={data}",
    ]
    command += [f"models={tmp_path / 'models'}", f"out={tmp_path / 'firmware' / 'swg'}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "labels as in Python (0 without a decision)" in done.stdout
    assert {"swg.h", "model.h", "gear.c", "window.c"} <= {path.name for path in (tmp_path / "firmware/swg").iterdir()}


def test_gears_differ_in_one_file_and_a_kept_model_is_taken(export, tmp_path):
    first = {path.name: path.read_bytes() for path in export("exported_gear=1").iterdir()}
    (kept,) = (tmp_path / "models").glob("*.skops")
    second = {path.name: path.read_bytes() for path in export("exported_gear=2", f"model={kept}").iterdir()}
    assert [name for name in first if first[name] != second[name]] == ["gear.c"]


def test_an_export_that_is_not_its_original_is_warned_of(export, caplog, monkeypatch):
    with caplog.at_level(logging.INFO):
        export("numbers=int16")
    assert caplog.records[-1].levelname == "INFO"
    monkeypatch.setattr("learn.embedded.export_job.FAITHFUL", 100.1)
    with caplog.at_level(logging.INFO):
        export("numbers=int16")
    assert caplog.records[-1].levelname == "WARNING"


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
        export()
    assert not (tmp_path / "models").exists()
