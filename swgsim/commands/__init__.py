"""The command line: ``swg NAME choice=value``, one command for each file of ``conf/`` that has a function.

The functions are entry points of the group ``swg.commands`` in pyproject.toml, so that this subpackage imports no job
and knows nothing of ``learn``.
"""

from swgsim.commands.command import command

__all__ = ["command"]
