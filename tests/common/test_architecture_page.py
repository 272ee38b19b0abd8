"""docs/architecture.md names files, subpackages and functions of the code as they are."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
QUOTED = set(re.findall(r"`([^`\n]+)`", PAGE))
# A function or class, and the file that defines it.
PLACED = re.findall(r"`([A-Za-z_][\w.]*)`\s+\(`([\w/]+)\.py`", PAGE)


def place(path: str) -> str:
    """A path of the page from the root of the repository; short ones are of the identification."""
    return path if path.split("/")[0] in ("swgsim", "learn") else f"swgsim/identification/{path}"


def defined(path: Path) -> Iterator[str]:
    """Functions, classes and methods of a file."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
            yield from (f"{node.name}.{each.name}" for each in node.body if isinstance(each, ast.FunctionDef))


@pytest.mark.parametrize("path", sorted(name for name in QUOTED if name.endswith(".py")))
def test_files_exist(path: str) -> None:
    assert (ROOT / place(path)).is_file()


@pytest.mark.parametrize("path", sorted(name for name in QUOTED if re.fullmatch(r"(swgsim|learn)/[\w/]+/?", name)))
def test_folders_exist(path: str) -> None:
    assert (ROOT / path).is_dir()


@pytest.mark.parametrize(("name", "path"), PLACED)
def test_names_are_in_their_files(name: str, path: str) -> None:
    assert name in set(defined(ROOT / f"{place(path)}.py"))


def test_all_names_with_a_dot_have_a_file() -> None:
    placed = {name for name, _ in PLACED}
    dotted = {name for name in QUOTED if re.fullmatch(r"[A-Z][a-z]\w*\.\w+", name)}
    assert dotted <= placed


@pytest.mark.parametrize("package", ["swgsim", "learn"])
def test_the_tables_list_every_subpackage(package: str) -> None:
    table = PAGE.split(f"| `{package}`, from top to bottom | |")[1].split("\n\n")[0]
    listed = re.findall(r"`(\w+)`", " ".join(row.split("|")[1] for row in table.splitlines() if row))
    reasons = PAGE.split(f"| `{package}`, the largest first |")[1].split("\n\n")[0]
    explained = re.findall(r"^\| `(\w+)` \|", reasons, re.MULTILINE)
    assert set(listed) == set(explained) == {each.parent.name for each in (ROOT / package).glob("*/__init__.py")}
