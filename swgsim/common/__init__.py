"""What every room uses: checked input, whole files, seeds, number formats, page style, engines for many tasks.

Imports no other room.
"""

from swgsim.common.checks import (
    require,
    require_integer,
    require_known,
    require_one_of,
    require_positive,
    require_range,
)
from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker, write_json, write_text
from swgsim.common.html import environment
from swgsim.common.numbers import NORMAL
from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN, Outcome
from swgsim.common.seeds import generator, seed_hash
from swgsim.common.singular import svd
from swgsim.common.style import png, words
from swgsim.common.version import code_version

__all__ = [
    "FOUND",
    "NORMAL",
    "NOTHING",
    "UNKNOWN",
    "Engine",
    "Outcome",
    "code_version",
    "environment",
    "generator",
    "png",
    "replacing",
    "require",
    "require_integer",
    "require_known",
    "require_one_of",
    "require_positive",
    "require_range",
    "seed_hash",
    "sole_maker",
    "svd",
    "words",
    "write_json",
    "write_text",
]
