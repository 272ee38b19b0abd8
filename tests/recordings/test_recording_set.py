"""Reading of every format through one function, its result, and messages for common mistakes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from recording_fixtures import assert_same, recording, save_csv

from swgsim.recordings import RecordingSet, read_recordings, write_file, write_folder
from swgsim.recordings.read import inspect_recordings

GOOD = tuple(recording(number, 600) for number in (1, 2, 3))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("set") / "bench"
    write_folder(path, GOOD)
    return path


def test_a_folder_and_a_file_give_the_same_set(folder: Path) -> None:
    write_file(folder.parent / "bench.h5", GOOD)
    for source in (folder, str(folder), folder.parent / "bench.h5"):
        found = read_recordings(source)
        assert_same(list(found), GOOD)
        assert_same((found[1], found["run 3"]), GOOD[1:])
        assert len(found) == 3
        assert [(defect.kind, defect.severity) for defect in found.defects] == [("short", "warn")] * 3


def test_a_set_describes_itself(folder: Path) -> None:
    found = read_recordings(folder)
    table = found.table()
    assert table["name"].tolist() == ["run 1", "run 2", "run 3"]
    assert table.iloc[0, 1:-1].tolist() == ["A, 17", "monday", 2000, 39.5, 1, pytest.approx(0.2)]
    assert table["channels"].tolist() == ["phi_in n_in T_in T_out s0 s1 s2 s3 s4"] * 3
    for text in (repr(found), found._repr_html_()):
        assert "3 recordings at 1 operating points; gear A, 17; session monday" in text
        assert "[short]; also in 2 others: run 2, run 3" in text
    assert repr(found[0]).startswith(
        "Recording('run 1': gear A, 17, session monday, 2000 rpm, 39.5 N m, repeat 1, 0.2 s"
    )
    assert repr(RecordingSet(())) == "RecordingSet: empty"
    with pytest.raises(ValueError, match=r"no recording 'run 9' in .*bench; choose from run 1, run 2, run 3"):
        found["run 9"]


def test_a_set_draws_the_gauges_of_a_recording(folder: Path) -> None:
    axes = read_recordings(folder).plot("run 2", Figure().subplots())
    angle, signal = axes.lines[1].get_data()
    np.testing.assert_allclose(angle, np.degrees(GOOD[1].channels["phi_in"]) % 360)
    np.testing.assert_array_equal(signal, GOOD[1].channels["s1"])
    torques = RecordingSet((replace(GOOD[0], channels={"T_in": GOOD[0].channels["T_in"]}),))
    with pytest.raises(ValueError, match="recording run 1 has no gauge; its channels are T_in"):
        torques.plot()


def test_defects_that_forbid_use_are_listed_and_can_be_inspected(tmp_path: Path) -> None:
    wrong = {"phi_in": 180 / np.pi, "s2": -1}
    spoiled = [
        replace(each, channels={name: wrong.get(name, 1) * values for name, values in each.channels.items()})
        for each in GOOD
    ]
    write_folder(tmp_path / "bench", spoiled)
    with pytest.raises(ValueError, match="cannot be used") as error:
        read_recordings(tmp_path / "bench")
    assert "[angle_in_degrees]; also in 2 others: run 2, run 3" in str(error.value)
    assert "[gauge_inverted]" in str(error.value)
    assert "warn" not in str(error.value)
    found = inspect_recordings(tmp_path / "bench")
    assert_same(found.recordings, spoiled)
    assert {"angle_in_degrees", "gauge_inverted", "short"} <= {defect.kind for defect in found.defects}


def test_files_of_single_channels_are_explained(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"found nothing, expected a folder with manifest\.csv.*mapping="):
        read_recordings(tmp_path / "absent")
    for name in ("phi_in", "s1"):
        save_csv(tmp_path / f"{name}.csv", {"t_s": GOOD[0].time, name: GOOD[0].channels[name]})
    with pytest.raises(ValueError, match=r"no manifest\.csv for phi_in\.csv, s1\.csv.*swg map drafts one"):
        read_recordings(tmp_path)
    single = [
        replace(each, channels={name: each.channels[name]}) for each, name in zip(GOOD, ("s1", "s2"), strict=False)
    ]
    with pytest.raises(ValueError, match=r"found the channels s2_mv_v.*files of single channels are joined"):
        write_folder(tmp_path / "bench", single)
