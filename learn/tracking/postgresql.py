"""PostgreSQL on a folder of one's own, reached through a socket in that folder and by no network."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import quote

DEBIAN = Path("/usr/lib/postgresql")  # which has a folder for each version
USER = "mlflow"
OWNER = "postgres"  # Debian's user for it, to whom root steps down: PostgreSQL refuses to run as root


@contextmanager
def database(folder: Path) -> Iterator[str]:
    """The address of the database in a folder, which is made if it is new and runs until the end of the context.

    What a killed process left running is started again.

    Raises
    ------
    ValueError
        If PostgreSQL is not installed, or not in the version that made the folder.
    RuntimeError
        If it does not start; with its own words.
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
    """Whether PostgreSQL works in a folder. After a power failure its number may be that of another process."""
    try:
        number = int((folder / "postmaster.pid").read_text().split()[0])
        return Path(f"/proc/{number}/cwd").resolve(strict=True) == folder
    except (OSError, ValueError, IndexError):
        return False


def _programs(folder: Path) -> Path:
    """Where the programs of the version are that made the folder, of the newest one for a new folder."""
    elsewhere = shutil.which("postgres")
    found = [*DEBIAN.glob("*/bin/postgres"), *([Path(elsewhere)] if elsewhere else [])]
    versions = {_version(program): program.parent for program in found}
    if not versions:
        raise ValueError("PostgreSQL is not installed: 'apt-get install postgresql' on Debian, then start again")
    kept = folder / "PG_VERSION"
    version = int(kept.read_text()) if kept.is_file() else max(versions)
    if version not in versions:
        raise ValueError(
            f"{folder} is of PostgreSQL {version}, installed is {', '.join(map(str, sorted(versions)))}: "
            f"install postgresql-{version}, convert the folder with pg_upgrade, or choose another with folder=..."
        )
    return versions[version]


def _version(program: Path) -> int:
    """Number of the version of a program, which says: postgres (PostgreSQL) 15.14 (Debian 15.14-0+deb12u1)."""
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return int(said.split()[2].partition(".")[0])


def _create(programs: Path, folder: Path) -> None:
    """Made aside, then renamed. Nobody is asked for a password: only the owner may enter the folder with the socket."""
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
