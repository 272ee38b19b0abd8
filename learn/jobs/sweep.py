"""Opens the common run of a sweep before its jobs start, and closes it afterwards."""

from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf, open_dict

from learn import tracking
from learn.jobs import settings


class Sweep(Callback):
    """Hydra's callback of ``conf/train.yaml``."""

    def on_multirun_start(self, config: DictConfig, **_: Any) -> None:
        """Let the command line override the experiment's own sweep, and open the study's run."""
        named = named_on_command_line(list(config.hydra.overrides.task))
        with open_dict(config.hydra.sweeper):
            swept = config.hydra.sweeper.params or {}  # None without an experiment
            for key in named:
                swept.pop(key, None)
        try:
            store = _store(config)
            self._run = tracking.open_sweep(store, config.study, named.get("grid", config.grid.name))
        except ValueError as error:  # Hydra would make it a warning, and start the jobs
            raise SystemExit(str(error)) from error
        # Hydra composes every job from these words on the machine that runs it.
        config.hydra.overrides.hydra.append(f"+hydra.job.env_set.{tracking.SWEEP}={self._run}")

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        """Close the study's run."""
        tracking.close_sweep(_store(config), self._run)


def named_on_command_line(overrides: list[str]) -> dict[str, str]:
    """The keys that the overrides set, with their values as written.

    >>> named_on_command_line(["experiment=table7", "classifier=rf,knn"])
    {'experiment': 'table7', 'classifier': 'rf,knn'}
    """
    parsed = OverridesParser.create().parse_overrides(overrides)
    return {override.key_or_group: str(override.input_line).partition("=")[2] for override in parsed}


def _store(config: DictConfig) -> tracking.Store:
    return settings.store(OmegaConf.to_container(config.tracking, resolve=True))  # type: ignore[arg-type]
