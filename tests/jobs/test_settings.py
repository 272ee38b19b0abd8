"""Every choice in conf/ makes an object, and a wrong one is answered with the choices there are."""

import inspect
from pathlib import Path

import pytest
import torch
import yaml
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn.adaptation.adaptations import ADAPTATIONS
from learn.jobs import settings, train_job

CONF = Path(__file__).parents[2] / "conf"
MAKERS = {
    "features": settings.representation,
    "classifier": settings.classifier,
    "adaptation": settings.adaptation,
    "protocol": settings.protocol,
    "tracking": settings.store,
}


@pytest.mark.parametrize(
    "path",
    [p for group in MAKERS for p in sorted((CONF / group).glob("*.yaml")) if p.stem not in ("none", "own")],
    ids=str,
)
def test_every_choice_of_the_configuration_makes_an_object(path, monkeypatch):
    monkeypatch.delenv("MLFLOW_TRACKING_URI", raising=False)
    written = OmegaConf.create(path.read_text().replace("${seed}", "0"))
    # Other groups refer to one another.
    config = OmegaConf.to_container(written, resolve=path.parent.name == "tracking")
    assert config["name"] == path.stem
    assert MAKERS[path.parent.name](config) is not None


@pytest.mark.parametrize("group", ["classifier", "adaptation", "protocol"])
def test_defaults_are_what_the_configuration_says(group):
    makers = {"classifier": settings.CLASSIFIERS, "adaptation": ADAPTATIONS, "protocol": settings.PROTOCOLS}[group]
    for name, maker in makers.items():
        config = yaml.safe_load((CONF / group / f"{name}.yaml").read_text().replace("${seed}", "0"))
        options = inspect.signature(maker).parameters.items()
        defaults = {key: option.default for key, option in options if option.default is not option.empty}
        assert {key: config[key] for key in defaults if key in config} == {
            key: value for key, value in defaults.items() if key in config
        }, name


@pytest.mark.parametrize(
    ("maker", "config", "message"),
    [
        (settings.classifier, {"name": "forest"}, "unknown classifier 'forest'; choose from mlp, svm, rf, knn, nb"),
        (
            settings.classifier,
            {"name": "rf", "tress": 3},
            "unknown option 'tress' of classifier rf; choose from trees, depth",
        ),
        (settings.classifier, {"name": "nb", "trees": 3}, "unknown option 'trees' of classifier nb; choose from none"),
        (settings.adaptation, {"name": "magic"}, "unknown adaptation 'magic'; choose from added_trees, batch_norm"),
        (
            settings.protocol,
            {"name": "folds"},
            "unknown protocol 'folds'; choose from random_folds, grouped_folds, leave_one",
        ),
        (settings.store, {"name": "cloud"}, "unknown tracking 'cloud'; choose from local, server"),
        (settings.store, {"name": "server", "uri": "host"}, "tracking.uri='host' is not an address of a server"),
        (
            settings.representation,
            {"name": "x", "order": 3},
            "unknown option 'order' of features x; choose from name, statistics",
        ),
    ],
)
def test_a_wrong_choice_is_answered_with_the_choices(maker, config, message):
    with pytest.raises(ValueError, match=message):
        maker(config)


def test_a_missing_data_set_is_answered_with_those_that_exist_and_the_whole_command(tmp_path, monkeypatch):
    (tmp_path / "small-clean.h5").touch()
    config = {"data": str(tmp_path), "grid": "paper", "condition": "clean"}
    command = f"swg generate grid=paper condition=clean data={tmp_path}"
    with pytest.raises(ValueError, match=rf"data sets in .*: small-clean\. .*: {command}$"):
        settings.data_set(config)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=rf"no data set {tmp_path}/data/paper-clean.h5.* condition=clean$"):
        settings.data_set({**config, "data": "data"})


def test_the_command_that_makes_runs_names_folders_and_servers():
    config = {"grid": {"name": "small"}, "data": "data", "tracking": {"name": "local", "folder": "mlruns"}}
    assert settings.train_command(config) == "swg train grid=small"
    elsewhere = {**config, "data": "my data", "tracking": {"name": "local", "folder": "my runs"}}
    assert settings.train_command(elsewhere) == "swg train grid=small data='my data' tracking.folder='my runs'"
    server = {**config, "tracking": {"name": "server", "uri": "http://host:1"}}
    assert settings.train_command(server) == "swg train grid=small tracking=server tracking.uri=http://host:1"


@pytest.mark.parametrize("chosen", ["auto", "cpu"])
def test_the_key_of_a_job_names_the_device_that_auto_means(chosen, monkeypatch, tmp_path):
    keys = []
    (tmp_path / "few-clean.h5").touch()
    monkeypatch.setattr(train_job.storage, "digest", lambda path: "digest")
    monkeypatch.setattr(train_job.settings, "store", lambda config: None)
    monkeypatch.setattr(
        train_job.tracking, "finished_metrics", lambda store, key: keys.append(key) or {"test_score": 1.0}
    )
    with initialize_config_dir(str(CONF), version_base="1.3"):
        options = ["grid=few", "classifier=perceptron", f"classifier.device={chosen}", f"data={tmp_path}"]
        config = OmegaConf.to_container(compose("train", options), resolve=True)
    for found in (False, True):
        monkeypatch.setattr(torch.cuda, "is_available", lambda found=found: found)
        train_job.run(config)
    assert len(set(keys)) == (2 if chosen == "auto" else 1)
