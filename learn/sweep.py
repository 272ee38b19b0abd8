"""What happens around the jobs of a sweep: the store is made ready before they start, their common run closed after."""

from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf, open_dict

from learn import page, settings, tracking


class Sweep(Callback):
    """Hydra's callback of ``conf/train.yaml``."""

    def on_multirun_start(self, config: DictConfig, **_: Any) -> None:
        """Let the command line win over the experiment's own sweep, and open the study's run in a store that exists."""
        with open_dict(config.hydra.sweeper):
            for key in named_on_command_line(list(config.hydra.overrides.task)):
                config.hydra.sweeper.params.pop(key, None)
        store = _store(config)
        tracking.open_sweep(store, config.study)
        page.save_views(store)

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        """Close the study's run."""
        tracking.close_sweep(_store(config), config.study)


def named_on_command_line(overrides: list[str]) -> list[str]:
    """The keys that the overrides set.

    >>> named_on_command_line(["experiment=table7", "classifier=rf,knn"])
    ['experiment', 'classifier']
    """
    return [override.key_or_group for override in OverridesParser.create().parse_overrides(overrides)]


def _store(config: DictConfig) -> tracking.Store:
    return settings.store(OmegaConf.to_container(config.tracking, resolve=True))  # type: ignore[arg-type]
