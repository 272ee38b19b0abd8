"""Hydra's launcher of sweeps whose jobs are worked off where those of data sets are: this machine or a Dask cluster."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hydra.core.singleton import Singleton
from hydra.core.utils import JobReturn, configure_log
from hydra.plugins.launcher import Launcher
from hydra.types import HydraContext, TaskFunction
from omegaconf import DictConfig


class EngineLauncher(Launcher):
    """That of ``conf/hydra/launcher/engine.yaml``; its parameters are those of :meth:`Engine.of`."""

    def __init__(self, **chosen: Any) -> None:
        self._chosen = chosen

    def setup(self, *, hydra_context: HydraContext, task_function: TaskFunction, config: DictConfig) -> None:
        """Keep what Hydra says of the sweep."""
        self._context, self._function, self._config = hydra_context, task_function, config

    def launch(self, job_overrides: Sequence[Sequence[str]], initial_job_idx: int) -> list[JobReturn]:
        """Do the jobs; one that fails is told of by Hydra when all are done."""
        from hydra_plugins.hydra_joblib_launcher._core import execute_job

        from learn.jobs.identity import code_version
        from swgsim.common.compute import Engine

        configure_log(self._config.hydra.hydra_logging, self._config.hydra.verbose)
        Path(self._config.hydra.sweep.dir).mkdir(parents=True, exist_ok=True)
        state = Singleton.get_state()
        tasks = (
            (number, overrides, self._context, self._config, self._function, state)
            for number, overrides in enumerate(job_overrides, initial_job_idx)
        )
        return list(Engine.of(self._chosen).results(execute_job, tasks, len(job_overrides), code_version))
