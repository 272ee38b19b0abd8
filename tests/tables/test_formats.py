"""Each layout of docs/formats.md is read by its map alone, and the page shows that map."""

from pathlib import Path

import numpy as np
import pytest
from formats import EXAMPLES, PAGE, TIME, Example, page

from swgsim.joint.intake.read import read_joints
from swgsim.recordings.read import inspect_recordings


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.title)
def test_a_layout_is_read_by_its_map(tmp_path: Path, example: Example) -> None:
    folder, path = tmp_path / "files", tmp_path / "map.yaml"
    folder.mkdir()
    example.write(folder)
    path.write_text(example.map, encoding="utf-8")
    if "s1" in example.of:
        found, *others = inspect_recordings(folder, path)
        signals = found.channels
    else:
        found, *others = read_joints(folder, path).recordings
        signals = found.signals
    assert len(others) == ("each" in example.map)
    rows = len(found.time)
    assert rows >= len(TIME) - 1
    np.testing.assert_allclose(found.time - found.time[0], TIME[:rows], atol=1e-7)
    assert set(signals) == set(example.of)
    for name, values in example.of.items():
        error = np.abs(signals[name] - values[:rows])[5:-5].max()
        assert error <= example.tolerance * np.abs(values).max(), name


def test_the_page_shows_the_maps_that_were_read() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()
