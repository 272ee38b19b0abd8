"""Versions of code: what depends on a module has another one when the module changes."""

import pytest

from swgsim.version import code_version


def test_a_version_with_the_loop_is_another_one():
    assert len({code_version(), code_version("loop"), code_version("loop", "virtual_bench.py")}) == 3


def test_a_module_that_is_not_there_is_refused():
    with pytest.raises(ValueError, match=r"unknown choice 'lop'.*loop"):
        code_version("lop")
