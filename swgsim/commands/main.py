"""The entry of the console command ``swg`` and of ``python -m swgsim``."""

import difflib
import sys

from swgsim.commands.command import command, commands, description
from swgsim.common.version import version_text

USAGE = """usage: swg COMMAND [choice=value ...]

The workbench for the condition of strain wave gears.

commands:
{commands}

'swg COMMAND --help' lists the choices of a command, 'swg COMMAND --cfg job' their values.
Documentation: docs/ of the repository, or 'make site'."""


def main(arguments: list[str] | None = None) -> int:
    """Run a command, or list the commands; returns the exit status."""
    words = sys.argv[1:] if arguments is None else arguments
    known = commands()
    if not words or words[0] in ("-h", "--help", "help"):
        width = max(map(len, known))
        print(USAGE.format(commands="\n".join(f"  {name:{width}}  {description(name)}" for name in known)))
        return 0
    if words[0] in ("-V", "--version"):
        print(version_text())
        return 0
    if words[0] not in known:
        near = difflib.get_close_matches(words[0], known, n=3)
        hint = f"did you mean {' or '.join(near)}?" if near else "'swg --help' lists the commands"
        print(f"unknown command {words[0]!r}: {hint}", file=sys.stderr)
        return 2
    command(words[0], words[1:])
    return 0
