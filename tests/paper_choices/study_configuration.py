"""The configuration of the study, for its tests."""

from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn.paper_choices.choice import Choice
from swgsim.common.configured import conf_folder


def composed(name, *overrides):
    """A resolved configuration of ``conf/``."""
    with initialize_config_dir(str(conf_folder()), version_base="1.3"):
        return OmegaConf.to_container(compose(name, list(overrides)), resolve=True)


CONFIG = composed("paper_choices")
CHOICES = [Choice(name=name, **options) for name, options in CONFIG["choices"].items()]
USUAL = {each.name: each.usual for each in CHOICES}
