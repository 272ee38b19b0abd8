"""Versions of code: what depends on a module has another one when the module changes."""

import shutil

import pytest

from swgsim.common import version
from swgsim.common.version import code_version


def test_a_version_with_another_room_is_another_one():
    assert len({code_version(), code_version("identification"), code_version("identification", "blind")}) == 3


def test_a_room_that_is_not_there_is_refused():
    with pytest.raises(ValueError, match=r"unknown choice 'identifiction'.*identification"):
        code_version("identifiction")


@pytest.mark.parametrize("module", ["oracle/point.py", "oracle/cells.py", "chain/steady_window.py"])
def test_the_key_of_a_kept_oracle_changes_with_every_module_it_is_made_of(module, tmp_path, monkeypatch):
    copy = tmp_path / "swgsim"
    shutil.copytree(version.PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(version, "PACKAGE", copy)
    found = []
    for _ in range(2):
        code_version.cache_clear()
        found.append(code_version("oracle"))
        (copy / module).write_text((copy / module).read_text(encoding="utf-8") + "# changed\n", encoding="utf-8")
    code_version.cache_clear()
    assert found[0] != found[1]
