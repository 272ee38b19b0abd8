"""Kills, full disks, read-only folders, clocks, locales and Ctrl-C: no result is lost, no file is incomplete."""

import errno
import json
import locale
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf
from prepared_store import prepared
from tqdm import tqdm

from learn import tracking
from swgsim.dataset import plan as plans
from swgsim.jobs import generate_data_set as generation
from swgsim.storage import storage

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]
ROOT = Path(__file__).parents[2]
PARTS = 6
BLOCK = 9  # recordings in a part: two parts of each gear
TINY = (
    "grid=small", "grid.classes=[healthy,reduced_damping]", "grid.variants=3", "grid.positions=1",
    "grid.references=12", "grid.speeds_rpm=[2000]", "grid.loads_nm=[7]", "mesh.sectors=60", "workers=1",
)  # fmt: skip


def tiny(folder: Path) -> dict[str, Any]:
    """A data set of 54 recordings."""
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose("generate", [*TINY, f"data={folder}"]), resolve=True)


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six parts."""
    monkeypatch.setattr(plans, "BLOCK", BLOCK)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The expected bytes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plans, "BLOCK", BLOCK)
        return Path(generation.run(tiny(tmp_path_factory.mktemp("undisturbed")))["path"]).read_bytes()


def made(folder: Path) -> bytes:
    """The bytes of a data set; its folder holds nothing else but its summary."""
    assert {path.name for path in folder.iterdir()} == {"small-clean.h5", "small-clean.json"}
    return (folder / "small-clean.h5").read_bytes()


# Kills.


def make(config: dict[str, Any]) -> None:
    """With a lock of its own for the progress bar: processes share it, and one that is killed never releases it."""
    tqdm.set_lock(threading.RLock())
    generation.run(config)


@pytest.mark.parametrize("finished", [0, 1, PARTS - 1])
def test_a_killed_data_set_is_continued_to_the_same_bytes(finished: int, tmp_path: Path, undisturbed: bytes) -> None:
    making = multiprocessing.get_context("fork").Process(target=make, args=[tiny(tmp_path)])
    making.start()
    while len(list(tmp_path.glob(".small-clean.h5.parts/*.h5"))) < finished:
        assert making.is_alive()
        time.sleep(0.002)
    making.kill()
    making.join()
    assert making.exitcode == -signal.SIGKILL
    generation.run(tiny(tmp_path))
    assert made(tmp_path) == undisturbed


# Full disks and read-only folders.


@contextmanager
def mounted(folder: Path, options: str) -> Iterator[None]:
    """A file system in memory at a folder."""
    folder.mkdir(exist_ok=True)
    command = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)]
    if os.geteuid() or subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("mounting is not allowed here")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk_is_named_and_finished_parts_are_reused(tmp_path: Path, undisturbed: bytes) -> None:
    folder = tmp_path / "disk"
    with mounted(folder, "size=600k"):
        with pytest.raises(OSError, match=r"No space left on device: .*\.h5 was not written; make room") as full:
            generation.run(tiny(folder))
        assert full.value.errno == errno.ENOSPC
        parts = sorted((folder / ".small-clean.h5.parts").iterdir())
        assert 0 < len(parts) < PARTS
        assert list(folder.iterdir()) == [parts[0].parent]
        written = [part.stat().st_mtime_ns for part in parts]
        with pytest.raises(OSError, match="make room"):
            generation.run(tiny(folder))
        assert [part.stat().st_mtime_ns for part in parts] == written
        subprocess.run(["mount", "-o", "remount,size=10m", str(folder)], check=True)
        generation.run(tiny(folder))
        assert made(folder) == undisturbed


def test_a_limit_of_file_sizes_is_named(tmp_path: Path, undisturbed: bytes) -> None:
    """The limit allows a few parts, which stay."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, limits[1]))
    try:
        with pytest.raises(OSError, match=r"File too large: .*small-clean\.h5 was not written; raise the limit"):
            generation.run(tiny(tmp_path))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert 1 < len(list((tmp_path / ".small-clean.h5.parts").iterdir())) < PARTS
    assert len(list(tmp_path.iterdir())) == 1
    generation.run(tiny(tmp_path))
    assert made(tmp_path) == undisturbed


def test_a_read_only_folder_is_named(tmp_path: Path) -> None:
    folder = tmp_path / "disk"
    message = r"small-clean\.h5 was not written; choose a folder that can be written"
    if os.geteuid():
        folder.mkdir(mode=0o500)
        with pytest.raises(PermissionError, match=message):
            generation.run(tiny(folder))
        return
    with mounted(folder, "ro"), pytest.raises(OSError, match=message) as refused:
        generation.run(tiny(folder))
    assert refused.value.errno == errno.EROFS


# Two processes.


def test_two_processes_make_one_data_set(tmp_path: Path, undisturbed: bytes) -> None:
    def make(ready: Any) -> None:
        ready.wait()
        try:
            generation.run(tiny(tmp_path))
        except RuntimeError as refused:
            sys.exit(2 if "another process is making" in str(refused) else 1)

    forking = multiprocessing.get_context("fork")
    ready = forking.Barrier(2)
    both = [forking.Process(target=make, args=(ready,)) for _ in range(2)]
    for process in both:
        process.start()
    for process in both:
        process.join()
    assert sorted(process.exitcode for process in both) in ([0, 0], [0, 2])
    assert made(tmp_path) == undisturbed


# Clocks and locales.

STRANGE = """
import json, sys, time
start = time.time()
time.time = lambda: start - 1e6 * time.perf_counter()  # a clock that is set back all the time
from pathlib import Path
from swgsim.common.files import write_text
from swgsim.dataset import plan
from swgsim.jobs import generate_data_set
plan.BLOCK = 9
generate_data_set.run(json.loads(sys.argv[1]))
write_text(Path(sys.argv[2]), "\\u03c8 \\u0130")
"""


@pytest.mark.parametrize("name", ["C", "de_DE.UTF-8", "tr_TR.UTF-8"])
def test_clock_and_locale_do_not_change_a_byte(name: str, tmp_path: Path, undisturbed: bytes) -> None:
    before = locale.setlocale(locale.LC_ALL)
    try:
        locale.setlocale(locale.LC_ALL, name)
    except locale.Error:
        pytest.skip(f"no locale {name} here")
    finally:
        locale.setlocale(locale.LC_ALL, before)
    surroundings = {**os.environ, "LC_ALL": name, "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    command = [sys.executable, "-c", STRANGE, json.dumps(tiny(tmp_path / "data")), str(tmp_path / "page.html")]
    done = subprocess.run(command, cwd=ROOT, env=surroundings, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert made(tmp_path / "data") == undisturbed
    assert (tmp_path / "page.html").read_bytes() == "\u03c8 \u0130".encode()


# Ctrl-C.


def interrupt(command: list[str], sign: Path, pattern: str) -> None:
    """Interrupt a program with all its processes once such a file exists; it reports that in few lines."""
    # A shell ignores Ctrl-C in its background processes, such as these tests, and so would the program.
    with subprocess.Popen(
        [sys.executable, "-m", "swgsim", *command],
        cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as running:  # fmt: skip
        while not list(sign.glob(pattern)):
            assert running.poll() is None, running.communicate()
            time.sleep(0.01)
        os.killpg(running.pid, signal.SIGINT)
        _, message = running.communicate()
    assert running.returncode == 130
    assert "interrupted; what is finished is kept" in message
    assert "Traceback" not in message


def test_ctrl_c_of_generate_leaves_finished_parts_only(tmp_path: Path, undisturbed: bytes) -> None:
    words = ["grid=small", "mesh.sectors=60", f"data={tmp_path}", "workers=2"]
    interrupt(["generate", *words], tmp_path, ".small-clean.h5.parts/*.h5")
    (parts,) = tmp_path.iterdir()
    # A worker that was killed leaves its lock, which blocks nobody.
    left = {part for part in parts.iterdir() if part.suffix != ".lock"}
    assert left == set(parts.glob("[0-9]*.h5"))
    for part in left:
        assert len(storage.read(part))


def test_ctrl_c_of_train_leaves_no_incomplete_result(tmp_path: Path) -> None:
    data = recordings(variants=4)
    storage.write(tmp_path / "small-clean.h5", [data], len(data))
    words = ["-m", "grid=small", "classifier=rf", "features=selection_1,selection_3", f"data={tmp_path}",
             f"tracking.folder={prepared(tmp_path / 'runs')}", f"hydra.sweep.dir={tmp_path / 'outputs'}"]  # fmt: skip
    interrupt(["train", *words, "workers=2"], tmp_path, "runs/artifacts/*/artifacts/*")
    store = tracking.local_store(str(tmp_path / "runs"))
    jobs = store.client.search_runs([store.experiment_id], "tags.kind = 'job'")
    assert jobs
    assert all("test_score" in run.data.metrics for run in jobs if run.info.status == "FINISHED")
    assert not list(tmp_path.rglob(".*.tmp"))


def test_a_store_whose_creation_was_killed_is_created_again(tmp_path: Path) -> None:
    for left in (".mlflow.db.tmp", ".mlflow.db.tmp-journal"):
        (tmp_path / left).write_bytes(b"of a process that was killed")
    assert tracking.local_store(str(tmp_path)).experiment_id
    assert {path.name.split("-")[0] for path in tmp_path.iterdir()} == {"mlflow.db"}
