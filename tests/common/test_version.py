"""Versions of code: what depends on a module has another one when the module changes."""

import pytest

from swgsim.common.version import code_version


def test_a_version_with_another_room_is_another_one():
    assert len({code_version(), code_version("identification"), code_version("identification", "blind")}) == 3


def test_a_room_that_is_not_there_is_refused():
    with pytest.raises(ValueError, match=r"unknown choice 'identifiction'.*identification"):
        code_version("identifiction")
