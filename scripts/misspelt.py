"""Answers a mistake in a command with a sentence, a misspelt choice with the list of choices.

Hydra does the latter for files of a group only, and the former at the end of a traceback.
"""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import interrupts
from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import CompactHydraException, ConfigCompositionException, OverrideParseException
from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

# Set to 1, the variable of Hydra that asks for tracebacks.
FULL = "HYDRA_FULL_ERROR"
CONF = Path(__file__).parent.parent / "conf"


def answered(main: Callable[[], object], config_name: str) -> None:
    """Run a Hydra main; where it fails, say why, and name the choices of every key that does not exist.

    Stops quietly at Ctrl-C.
    """
    interrupts.kept()
    try:
        with _in_a_sentence():
            main()
    except KeyboardInterrupt:
        print("\ninterrupted; what is finished is kept, and the same command goes on from there", file=sys.stderr)
        sys.exit(130)  # as a shell says it
    except SystemExit as stop:
        if stop.code:
            for answer in unknown(config_name, [word for word in sys.argv[1:] if not word.startswith("-")]):
                print(answer, file=sys.stderr)
        raise


@contextmanager
def _in_a_sentence() -> Iterator[None]:
    """Say what was wrong where it can be mended; any other error keeps its traceback.

    The errors of jobs come here from Hydra, that of a sweep once all of its jobs are done.
    """
    if os.environ.get(FULL) == "1":
        yield
        return
    os.environ[FULL] = "1"  # Hydra hands errors on and prints none
    try:
        yield
    except OverrideParseException as error:
        print(_unread(error), file=sys.stderr)
        raise SystemExit(1) from error
    except (CompactHydraException, ValueError, OSError) as error:
        print(error, file=sys.stderr)
        if isinstance(error.__cause__, OmegaConfBaseException):  # of a choice: Hydra says only which one
            print(error.__cause__, file=sys.stderr)
        print(f"({FULL}=1 shows where)", file=sys.stderr)
        raise SystemExit(1) from error
    finally:
        del os.environ[FULL]


def _unread(error: OverrideParseException) -> str:
    """What to write for a word that Hydra cannot read."""
    if "=" not in error.override:
        return f"cannot read {error.override!r}: choices are name=value, such as recordings=FOLDER"
    return (
        f"cannot read {error.override!r}: a value with such characters needs quotes of its own, such as "
        """'recordings="folder (1)"'"""
    )


def _is_group(override: Override) -> bool:
    return (CONF / override.key_or_group).is_dir()


def _first(override: Override) -> str:
    """An override with the first of the values that it sweeps."""
    return override.input_line.split(",")[0]


def unknown(config_name: str, words: list[str]) -> Iterator[str]:
    """One sentence for each override whose key the configuration does not have."""
    try:
        overrides = OverridesParser.create().parse_overrides(words)
    except OverrideParseException:
        return  # told already, if it was a choice at all and not the value of an option of Hydra's
    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(CONF), version_base="1.3"):
            config = compose(config_name, [_first(override) for override in overrides if _is_group(override)])
    except ConfigCompositionException:
        return  # a file of a group that does not exist: Hydra has listed those that do
    for override in overrides:
        key = override.key_or_group
        if override.is_add() or override.is_delete() or key.startswith("hydra") or _is_group(override):
            continue
        node = config
        for part in key.split("."):
            if not isinstance(node, DictConfig):
                break  # below a value, of which Hydra has said that it has nothing below it
            if part not in node:
                yield f"unknown choice {part!r}; choose from {', '.join(sorted(map(str, node)))}"
                break
            node = node[part]
