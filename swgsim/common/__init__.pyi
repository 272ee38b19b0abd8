from .checks import (
    require,
    require_integer,
    require_known,
    require_one_of,
    require_positive,
    require_range,
)
from .compute import Engine
from .files import replacing, sole_maker, write_json, write_text
from .html import environment
from .numbers import NORMAL
from .outcome import FOUND, NOTHING, UNKNOWN, Outcome
from .seeds import generator, seed_hash
from .singular import svd
from .style import png, words
from .version import code_version

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
