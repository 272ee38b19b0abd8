"""PostgreSQL with its data in a folder; reached through a socket in that folder, not through a network."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote

DEBIAN = Path("/usr/lib/postgresql")  # has a folder for each version
USER = "mlflow"
OWNER = "postgres"  # Debian's user for it, to whom root steps down: PostgreSQL refuses to run as root


@contextmanager
def database(folder: Path) -> Iterator[str]:
    """The address of the database in a folder, which is created if it is new and runs until the end of the context.

    A database that a killed process left running is restarted.

    Raises
    ------
    ValueError
        If PostgreSQL is not installed, or not in the version that made the folder.
    RuntimeError
        If it does not start; the message is that of PostgreSQL.
    """
    programs = _programs(folder)
    if not folder.exists():
        _create(programs, folder)
    options = f"-c listen_addresses= -k {shlex.quote(str(folder))}"
    control = [str(programs / "pg_ctl"), "-D", str(folder), "-m", "fast", "-w"]
    begin = "restart" if _runs(folder) else "start"
    _call(*control, "-l", str(folder / "server.log"), "-o", options, begin)
    try:
        yield f"postgresql+psycopg2://{USER}@/postgres?host={quote(str(folder))}"
    finally:
        _call(*control, "stop")


def _runs(folder: Path) -> bool:
    """Whether PostgreSQL runs in a folder. After a power failure its number may be that of another process."""
    try:
        number = int((folder / "postmaster.pid").read_text().split()[0])
        return Path(f"/proc/{number}/cwd").resolve(strict=True) == folder
    except (OSError, ValueError, IndexError):
        return False


def _programs(folder: Path) -> Path:
    """Folder of the programs, in the version that made the folder; for a new folder in the newest version."""
    elsewhere = shutil.which("postgres")
    found = [*DEBIAN.glob("*/bin/postgres"), *([Path(elsewhere)] if elsewhere else [])]
    versions = {_version(program): program.parent for program in found}
    if not versions:
        raise ValueError("PostgreSQL is not installed: 'apt-get install postgresql' on Debian, then start again")
    kept = folder / "PG_VERSION"
    version = int(kept.read_text()) if kept.is_file() else max(versions)
    if version not in versions:
        raise ValueError(
            f"{folder} was made by PostgreSQL {version}, installed is {', '.join(map(str, sorted(versions)))}: "
            f"install postgresql-{version}, convert the folder with pg_upgrade, or choose another with folder=..."
        )
    return versions[version]


def _version(program: Path) -> int:
    """Major version of a program, which prints: postgres (PostgreSQL) 15.14 (Debian 15.14-0+deb12u1)."""
    printed = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return int(printed.split()[2].partition(".")[0])


def _create(programs: Path, folder: Path) -> None:
    """Create it aside, then rename. It needs no password: only the owner may enter the folder with the socket."""
    aside = folder.with_name(f".{folder.name}.tmp")
    shutil.rmtree(aside, ignore_errors=True)
    aside.mkdir(mode=0o700, parents=True)
    if os.geteuid() == 0:
        shutil.chown(aside, OWNER)
    _call(str(programs / "initdb"), "-D", str(aside), "-U", USER, "--auth=trust", "--encoding=UTF8", "--locale=C.UTF-8")
    aside.rename(folder)


def _call(*command: str) -> None:
    as_owner = ["runuser", "-u", OWNER, "--"] if os.geteuid() == 0 else []
    done = subprocess.run([*as_owner, *command], capture_output=True, text=True, check=False, cwd="/")
    if done.returncode:
        raise RuntimeError(f"{shlex.join(command)} failed: {(done.stderr or done.stdout).strip()}")
