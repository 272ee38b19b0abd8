"""The run-time type checker of the tests; an int may stand where a float is expected (PEP 484)."""

from beartype import BeartypeConf, beartype

typecheck = beartype(conf=BeartypeConf(is_pep484_tower=True))
