"""One command: a configuration of ``conf/`` and the function that is run with it."""

import os
import sys
from collections.abc import Callable, Mapping
from importlib.metadata import entry_points
from typing import Any

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig

from swgsim.commands.mistakes import FULL, MENDABLE, answered, explain
from swgsim.commands.usage import usage
from swgsim.common.configured import conf_folder, plain

GROUP = "swg.commands"
# Functions that spell the words of a command as Hydra reads them.
SPELLINGS = "swg.spellings"


def commands() -> dict[str, Callable[[], Callable[[Mapping[str, Any]], Any]]]:
    """The commands by name; each value imports the function of its command."""
    return {entry.name: entry.load for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name)}


def description(name: str) -> str:
    """What a command does: the first comment of its configuration.

    >>> description("generate")
    'Generate a labelled data set of gauge signals.'
    """
    with (conf_folder() / f"{config_name(name)}.yaml").open(encoding="utf-8") as file:
        return file.readline().removeprefix("#").strip()


def config_name(name: str) -> str:
    """The name of a command's file in ``conf/``.

    >>> config_name("close-loop")
    'close_loop'
    """
    return name.replace("-", "_")


def command(name: str, arguments: list[str] | None = None) -> None:
    """Run a command with choices in Hydra's syntax, those of the command line if none are given.

    Errors that a user can correct end the process with a sentence and status 1 (:mod:`swgsim.commands.mistakes`).

    Parameters
    ----------
    name : str
        Such as "close-loop".
    arguments : list of str, optional
        Such as ["recordings=my_bench", "out=answer"].
    """

    traceback_wanted = os.environ.get(FULL) == "1"

    @hydra.main(version_base="1.3", config_path=str(conf_folder()), config_name=config_name(name))
    def main(config: DictConfig) -> Any:
        try:
            return commands()[name]()(plain(config))
        except MENDABLE as error:
            if traceback_wanted or HydraConfig.get().mode is RunMode.MULTIRUN:
                raise
            explain(error)  # here, since Hydra would print the overrides of the command before the error
            raise SystemExit(1) from error

    words = sys.argv[1:] if arguments is None else arguments
    if {"-h", "--help"} & set(words):
        print(usage(name, config_name(name)))
        return
    for entry in entry_points(group=SPELLINGS, name=name):
        words = entry.load()(words)
    # Hydra reads the process's arguments, and names the command in its help by the first of them.
    sys.argv = [f"swg {name}", *words]
    answered(main, config_name(name))
