"""Mistakes in a command end with a sentence instead of a traceback; a misspelt choice, with the nearest one and all."""

import difflib
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import (
    CompactHydraException,
    ConfigCompositionException,
    MissingConfigException,
    OverrideParseException,
)
from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

from swgsim.commands import interrupts
from swgsim.common.configured import conf_folder

# Hydra's variable that asks for tracebacks, by the value 1.
FULL = "HYDRA_FULL_ERROR"
# Errors that a user can correct; all others are defects of the code and keep their traceback.
MENDABLE = (CompactHydraException, ValueError, OSError)


def answered(main: Callable[[], object], config_name: str) -> None:
    """Run a Hydra main; explain a failure in a sentence, and name the choices of every key that does not exist.

    Ctrl-C ends it with one line and status 130.
    """
    interrupts.kept()
    try:
        with _explained(config_name):
            main()
    except KeyboardInterrupt as stop:
        kept = "interrupted; what is finished is kept, and the same command goes on from there"
        print(f"\n{str(stop) or kept}", file=sys.stderr)
        sys.exit(130)  # as a shell says it


def explain(error: BaseException) -> None:
    """Print an error as a sentence, and how to see where it was raised."""
    print(error, file=sys.stderr)
    if isinstance(error.__cause__, OmegaConfBaseException):  # of a choice: Hydra names the choice, its cause the reason
        print(error.__cause__, file=sys.stderr)
    print(f"({FULL}=1 shows where)", file=sys.stderr)


@contextmanager
def _explained(config_name: str) -> Iterator[None]:
    """Explain the errors that Hydra raises itself, and those of a sweep, which it raises when all jobs are done."""
    if os.environ.get(FULL) == "1":
        yield
        return
    os.environ[FULL] = "1"  # Hydra then hands errors on instead of printing them
    try:
        yield
    except OverrideParseException as error:
        print(_unread(error), file=sys.stderr)
        raise SystemExit(1) from error
    except MissingConfigException as error:  # a file of a group
        group, _, name = (error.missing_cfg_file or "").rpartition("/")
        if error.options is None:
            explain(error)
        else:
            print(f"unknown {group} {_nearest(name, error.options)}", file=sys.stderr)
        raise SystemExit(1) from error
    except ConfigCompositionException as error:
        answers = list(unknown(config_name, [word for word in sys.argv[1:] if not word.startswith("-")]))
        if answers:
            print("\n".join(answers), file=sys.stderr)
        else:
            explain(error)
        raise SystemExit(1) from error
    except MENDABLE as error:
        explain(error)
        raise SystemExit(1) from error
    finally:
        del os.environ[FULL]


def _unread(error: OverrideParseException) -> str:
    """The answer to a word that Hydra cannot read."""
    if "=" not in error.override:
        return f"cannot read {error.override!r}: choices are name=value, such as recordings=FOLDER"
    return (
        f"cannot read {error.override!r}: a value with such characters needs quotes of its own, such as "
        """'recordings="folder (1)"'"""
    )


def _nearest(name: str, choices: Iterable[str]) -> str:
    """A misspelt name with the nearest choice and all others."""
    known = sorted(choices)
    near = difflib.get_close_matches(name, known, n=1)
    guess = f"; did you mean {near[0]!r}?" if near else ";"
    return f"{name!r}{guess} choose from {', '.join(known)}"


def _is_group(override: Override) -> bool:
    return (conf_folder() / override.key_or_group).is_dir()


def _first(override: Override) -> str:
    """An override with the first of the values that it sweeps."""
    return (override.input_line or "").split(",")[0]


def unknown(config_name: str, words: list[str]) -> Iterator[str]:
    """One sentence for each override whose key the configuration does not have, the nearest key first."""
    try:
        overrides = OverridesParser.create().parse_overrides(words)
    except OverrideParseException:
        return  # answered already, or the value of an option of Hydra
    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(conf_folder()), version_base="1.3"):
            config = compose(config_name, [_first(override) for override in overrides if _is_group(override)])
    except ConfigCompositionException:
        return  # a file of a group that does not exist is answered already
    for override in overrides:
        key = override.key_or_group
        if override.is_add() or override.is_delete() or key.startswith("hydra") or _is_group(override):
            continue
        node = config
        for part in key.split("."):
            if not isinstance(node, DictConfig):
                break  # below a value: Hydra has refused it
            if part not in node:
                yield f"unknown choice {_nearest(part, map(str, node))}"
                break
            node = node[part]
