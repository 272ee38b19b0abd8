"""Read randomly damaged files with every reader: ``python scripts/fuzz.py --seconds 300`` (docs/reliability.md)."""

import argparse
import hashlib
import io
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
import zipfile
from collections import Counter
from collections.abc import Callable
from contextlib import nullcontext
from functools import partial
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # for the sound files

import format_fixtures as formats
import member_fixtures as members
import recording_fixtures as sound
from fabricated_joints import KINOVA, kinova_run, write_kinova

from learn.evaluation import models
from swgsim.bench.truth import SEAL, open_truth
from swgsim.effects import text
from swgsim.identification.fit.unit import Unit
from swgsim.identification.fit.unit_file import WHAT, read_unit
from swgsim.joint.intake.read import read_joints
from swgsim.recordings.files import sources
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.storage import storage
from swgsim.storage.storage import SEAL_SIZE, SEAL_START, seal_start
from swgsim.tables import binary
from swgsim.tables.formats import spreadsheet
from swgsim.tables.formats.limited import LimitedReader

# One child process reads all MATLAB files of a batch.
MATLAB = LimitedReader()
sources.LimitedReader = lambda: nullcontext(MATLAB)  # type: ignore[assignment,misc]

KEPT = Path("outputs/fuzz")
MEMORY, SECONDS, BATCH = 2 * 2**30, 10.0, 25  # beyond the libraries [byte]; of one reading [s]; readings of one process
HARMLESS = ("accepted", "refused")
# A reader that starts a process, opens a socket or removes a file runs something of the file.
FORBIDDEN = ("os.system", "os.exec", "os.posix_spawn", "os.fork", "socket.", "ctypes.dlopen", "os.remove", "os.rename")
WORDS = (
    b"nan", b"-inf", b"1e400", b"9" * 400, b"1" * 20_000 + b"x", b"0x1p3", b"1,5", b"", b"4294967296", b"2001-13-45",
    b"../../etc/passwd", b"a\x00b", b"\xff\xfe", b"\n\n", b'"', b"[" * 3000, b"{a: " * 300, b"&a [*a]", b"<<: {}",
    b"!!python/object/apply:os.system ['true']", b"x" * 5000, b"os:system", b"\xff" * 4, b"\x7f" + b"\xff" * 7,
)  # fmt: skip


def effects_file(place: Path) -> None:
    (place / "effects.yaml").write_text("effects:\n- eccentric_wave_generator: {r: 1.0e-5, theta: 1.0}\n")


def read_truth(place: Path) -> None:
    """The truth, sealed after the damage, as its maker could do."""
    content = (place / "bench.truth.json").read_bytes()
    (place / "bench" / SEAL).write_text(f"{hashlib.sha256(content).hexdigest()}  bench.truth.json\n")
    open_truth(place / "bench")


# Reader: writer of sound files, pattern of the files to damage, function that reads their folder.
READERS: dict[str, tuple[Callable[[Path], object], str, Callable[[Path], object]]] = {
    "CSV folder": (sound.bench_folder, "bench/*.csv", lambda place: read_folder(place / "bench")),
    "one file (.h5)": (sound.bench_file, "bench.h5", lambda place: read_file(place / "bench.h5")),
    **{
        saver: (
            partial(sound.mapped, saver=saver), "files/*",
            lambda place: sources.read_mapped(place / "files", read_map(place / "map.yaml")).recordings,
        )
        for saver in sound.SAVERS
    },
    **{
        name: (
            lambda place, name=name: formats.SAVED[name](place / name), name,
            lambda place, name=name: binary.read_columns(place / name, name, ["time", *formats.COLUMNS[name]], MATLAB),
        )
        for name in formats.COLUMNS
    },
    "a.xlsx": (
        lambda place: formats.save_xlsx(place / "a.xlsx"), "a.xlsx",
        lambda place: spreadsheet.cells(place / "a.xlsx", "a.xlsx", None, MATLAB),
    ),
    **{
        f"members of {save.__name__[5:]}.mat": (
            lambda place, save=save: save(place / "run1.mat"), "run1.mat",
            lambda place: binary.read_columns(place / "run1.mat", "run1.mat", list(members.MEANT), MATLAB),
        )
        for save in (members.save_v5, members.save_v73)
    },
    "column map": (partial(sound.mapped, saver="x.csv"), "map.yaml", lambda place: read_map(place / "map.yaml")),
    "joint logs": (
        lambda place: write_kinova(place / "S1_v0.50.csv", kinova_run(0.5, 1, 300)), "*.csv",
        lambda place: read_joints(place, KINOVA),
    ),
    "data set (.h5)": (sound.data_set, "set.h5", lambda place: storage.read(place / "set.h5")),
    "unit (.h5)": (sound.unit_file, "gear.unit.h5", lambda place: read_unit(place / "gear.unit.h5", Unit)),
    "network (.pt)": (sound.network, "model.pt", lambda place: models.load(place / "model.pt", "cpu")),
    "forest (.skops)": (sound.forest, "model.skops", lambda place: models.load(place / "model.skops", "cpu")),
    "effects.yaml": (effects_file, "effects.yaml", lambda place: text.from_text(
        (place / "effects.yaml").read_text(errors="replace"), "effects.yaml")),
    "truth (.json)": (sound.truth, "*.truth.json", read_truth),
}  # fmt: skip


def damaged(content: bytes, rng: np.random.Generator) -> bytes:
    """One to four changes, inside of a seal or of one member of an archive, which then fit again."""
    for start in (SEAL_START, seal_start(WHAT)):
        if content.startswith(start) and rng.random() < 0.8:
            return sound.sealed(damaged(content[SEAL_SIZE:], rng), start)
    if content.startswith(b"PK") and rng.random() < 0.8:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        chosen = str(rng.choice(sorted(members)))
        changed = io.BytesIO()
        with zipfile.ZipFile(changed, "w") as archive:
            for name, inside in members.items():
                archive.writestr(name, damaged(inside, rng) if name == chosen else inside)
        return changed.getvalue()
    for _ in range(int(rng.integers(1, 5))):
        start, end, to = (int(rng.integers(len(content) + 1)) for _ in range(3))
        word = WORDS[int(rng.integers(len(WORDS)))]
        content = [
            content[:start] + bytes([int(rng.integers(256))]) + content[start + 1 :],  # another byte
            content[:start] + word + content[start + len(word) * int(rng.integers(2)) :],  # inserted or overwritten
            content[:start],  # truncated
            content[:start] + content[start + int(rng.integers(1, 200)) :],  # a part missing
            content[:to] + content[start:end][:2000] + content[to:],  # a part copied
        ][int(rng.integers(5))]
    return content


def outcome(read: Callable[[Path], object], place: Path, events: list[str]) -> str:
    """Accepted, refused with the name of a file, or a kind of harm."""
    names = {str(place), *(path.name for path in place.rglob("*"))}
    try:
        read(place)
        found = "accepted"
    except MemoryError:
        found = "memory"
    except ValueError as error:
        sensible = hasattr(error, "file") or any(name in str(error) for name in names)
        found = "refused" if sensible else f"crashed: {error!r}"
    except BaseException:
        found = f"crashed: {traceback.format_exc(limit=-1)}"
    return f"executed: {events[0]}" if events else found


def read_in_child(read: Callable[[Path], object], place: Path, file: Path, contents: list[bytes]) -> list[str]:
    """Outcomes of all contents, from a fork with limits of memory and time; the last one may be the end of it."""
    report = place.parent / f"{place.name}.report"
    report.write_text("")
    child = os.fork()
    if not child:
        events: list[str] = []
        warnings.simplefilter("ignore")
        libraries = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (libraries + MEMORY,) * 2)
        sys.addaudithook(lambda event, _: events.append(event) if event.startswith(FORBIDDEN) else None)
        with report.open("w") as lines:
            for content in contents:
                file.write_bytes(content)
                signal.setitimer(signal.ITIMER_PROF, SECONDS)
                print(outcome(read, place, events).replace("\n", " ")[:300], file=lines, flush=True)
                events.clear()
        os._exit(0)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    found = report.read_text().splitlines()
    ended = "hung" if status == -signal.SIGPROF else f"crashed: exit status {status}"
    return found + [ended] * (len(found) < len(contents))


def campaign(name: str, seconds: float, rng: np.random.Generator) -> Counter:
    """Damage and read the files of one reader for a time, at least once; harmful files are kept."""
    write, pattern, read = READERS[name]
    tally: Counter = Counter()
    with tempfile.TemporaryDirectory(prefix="fuzz") as scratch:
        place = Path(scratch) / "files"
        place.mkdir()
        write(place)
        files = {file: file.read_bytes() for file in sorted(place.glob(pattern))}
        sound_file, content = next(iter(files.items()))
        if (found := read_in_child(read, place, sound_file, [content])) != ["accepted"]:
            raise RuntimeError(f"{name}: the sound files are {found[0]}")
        end = time.monotonic() + seconds
        while not tally or time.monotonic() < end:
            file = list(files)[int(rng.integers(len(files)))]
            contents = [damaged(files[file], rng) for _ in range(BATCH)]
            for content, found in zip(contents, read_in_child(read, place, file, contents), strict=False):
                tally[found] += 1
                if found not in HARMLESS:
                    KEPT.mkdir(parents=True, exist_ok=True)
                    (KEPT / f"{sum(tally.values()):05d}-{file.name}").write_bytes(content)
            file.write_bytes(files[file])
    return tally


def main() -> int:
    """Print a table; the exit status is 1 unless every file was read or refused."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=300, help="for all readers together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="part of the names of the readers")
    options = parser.parse_args()
    names = [name for name in READERS if options.only in name]
    print("| reader | files | accepted | refused | harm |\n|---|--:|--:|--:|---|")
    harmful = 0
    for number, name in enumerate(names):
        tally = campaign(name, options.seconds / len(names), np.random.default_rng([options.seed, number]))
        harm = {found: count for found, count in tally.items() if found not in HARMLESS}
        harmful += sum(harm.values())
        print(f"| {name} | {tally.total()} | {tally['accepted']} | {tally['refused']} | {harm or ''} |", flush=True)
    print("\nno harm" if not harmful else f"\n{harmful} harmful files, kept in {KEPT}")
    return 1 if harmful else 0


if __name__ == "__main__":
    sys.exit(main())
