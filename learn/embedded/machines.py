"""Machines for exported C: this computer, also with sanitizers, and emulated Cortex-M microcontrollers."""

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

BENCH = Path(__file__).parent / "bench"
LANGUAGE = ("-std=c11", "-Wall", "-Wextra", "-Wdouble-promotion", "-Werror")
PACKAGES = {"gcc": "gcc", "arm-none-eabi-gcc": "gcc-arm-none-eabi", "qemu-system-arm": "qemu-system-arm"}
NEWLIB = "libnewlib-arm-none-eabi"
SANITIZERS = ("-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all", "-g")
TIMEOUT = 600.0  # for a compiler, or for all recordings of a program [s]


@dataclass(frozen=True)
class Machine:
    """A processor with its compiler.

    Attributes
    ----------
    name : str
    compiler : tuple of str
        Command with the options of the processor.
    emulator : tuple of str or None
        Command before the program's path; None where programs run by themselves.
    """

    name: str
    compiler: tuple[str, ...]
    emulator: tuple[str, ...] | None = None


def _cortex(name: str, unit: str, board: str) -> Machine:
    processor = (f"-mcpu={name}", "-mthumb", "-mfloat-abi=hard", f"-mfpu={unit}")
    optimised = ("-O2", "-ffunction-sections", "-fdata-sections", "--specs=nano.specs")
    emulator = ("qemu-system-arm", "-machine", board, "-display", "none", "-serial", "none", "-monitor", "none")
    semihosting = ("-semihosting-config", "enable=on,target=native")
    return Machine(name, ("arm-none-eabi-gcc", *processor, *optimised), (*emulator, *semihosting))


HOST = Machine("host", ("gcc", "-O2"))
HOST_SANITIZED = Machine("host with sanitizers", ("gcc", "-O1", *SANITIZERS))
CORTEX_M4 = _cortex("cortex-m4", "fpv4-sp-d16", "mps2-an386")
CORTEX_M7 = _cortex("cortex-m7", "fpv5-sp-d16", "mps2-an500")


def missing(machine: Machine) -> list[str]:
    """Debian packages of a machine that are not installed."""
    tools = [machine.compiler[0], *(machine.emulator or ())[:1]]
    packages = [PACKAGES[tool] for tool in tools if shutil.which(tool) is None]
    if machine.emulator is not None and not packages and not _newlib_is_there(machine):
        packages.append(NEWLIB)
    return packages


def build(folder: Path, machine: Machine, out: Path) -> Path:
    """Compile an exported method with the bench, the program that :func:`learn.embedded.running.decide` runs.

    Parameters
    ----------
    folder : Path
        Folder of :func:`learn.embedded.export.export_c`.
    machine : Machine
    out : Path
        Folder for the program and its objects; it is made.

    Returns
    -------
    Path
        The program.

    Raises
    ------
    ValueError
        If a tool is not installed.
    RuntimeError
        If the compiler fails; with its message.
    """
    if machine.emulator is None:
        return link([*compile_objects(folder, machine, out, "main.c")], machine, out / "program", "-lm")
    objects = compile_objects(folder, machine, out, "main.c", "startup.c")
    return link(objects, machine, out / "program", "--specs=rdimon.specs")


def compile_objects(folder: Path, machine: Machine, out: Path, *of_bench: str) -> list[Path]:
    """Compile the C files of a folder and some of the bench's; each gives an object with its name in ``out``."""
    require_tools(machine)
    sources = [*sorted(folder.resolve().glob("*.c")), *(BENCH / name for name in of_bench)]
    out.mkdir(parents=True, exist_ok=True)
    call([*machine.compiler, *LANGUAGE, f"-I{folder.resolve()}", "-c", *map(str, sources)], out)
    return [out / f"{source.stem}.o" for source in sources]


def link(objects: list[Path], machine: Machine, program: Path, *options: str) -> Path:
    """Link objects; for a microcontroller without unused sections and with the bench's memory layout."""
    layout = () if machine.emulator is None else ("-nostartfiles", "-Wl,--gc-sections", f"-T{BENCH / 'cortex-m.ld'}")
    paths = [str(path.resolve()) for path in objects]
    call([*machine.compiler, *layout, *paths, *options, "-lm", "-o", str(program.resolve())], program.parent)
    return program


def require_tools(machine: Machine) -> None:
    """Raise a ValueError that names the Debian packages which a machine lacks."""
    packages = missing(machine)
    if packages:
        remedy = "'apt-get install gcc'" if machine.emulator is None else "scripts/install_arm.sh"
        raise ValueError(f"{machine.name} needs the Debian package {', '.join(packages)}: run {remedy}")


def call(command: list[str], folder: Path) -> None:
    """Run a command in a folder; raise a RuntimeError with the end of its output if it fails."""
    quiet: dict[str, Any] = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True}
    try:
        done = subprocess.run(command, cwd=folder, timeout=TIMEOUT, check=False, **quiet)
    except subprocess.TimeoutExpired as error:
        raise RuntimeError(f"{command[0]} was stopped after {TIMEOUT:g} s in {folder}") from error
    if done.returncode:
        output = (done.stderr + done.stdout)[-3000:]
        raise RuntimeError(f"{command[0]} failed with status {done.returncode} in {folder}:\n{output}")


def _newlib_is_there(machine: Machine) -> bool:
    """Whether the compiler has its C library; for a missing file it prints the bare name."""
    command = [machine.compiler[0], "-print-file-name=rdimon.specs"]
    return Path(subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()).is_absolute()
