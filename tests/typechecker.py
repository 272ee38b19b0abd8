"""The run-time type checker of the tests; an int may stand where a float is expected (PEP 484)."""

from collections.abc import Callable
from functools import cache, wraps

from beartype import BeartypeConf, beartype

compiled = beartype(conf=BeartypeConf(is_pep484_tower=True))


def typecheck(function: Callable) -> Callable:
    """The function with checks, which its first call compiles: many functions are never called in a worker."""
    checked = cache(lambda: compiled(function))

    @wraps(function)
    def wrapper(*args, **kwargs):
        return checked()(*args, **kwargs)

    return wrapper
