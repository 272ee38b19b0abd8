"""Flash and RAM of an exported method on a microcontroller, from the linker's map."""

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from learn.embedded.machines import Machine, compile_objects, link

IN_FLASH = (".text", ".rodata", ".ARM.exidx", ".data")
IN_RAM = (".data", ".bss", "COMMON")

# " .text.swg_push  0x00000010  0x1c4 /folder/window.o", or a library's "/folder/libm.a(member.o)".
PLACED = re.compile(r"^ (\S+)\s+0x[0-9a-f]+\s+0x([0-9a-f]+) (\S.*)$", re.MULTILINE)


@dataclass(frozen=True)
class Sizes:
    """Bytes that ``swg_push`` and ``swg_decide`` add to a firmware.

    Attributes
    ----------
    flash : dict of int
        By C file without its ending, and by library of the compiler; without the few bytes of alignment.
    ram : int
        Static, with one window; the stack is of :class:`learn.embedded.running.Decisions`.
    """

    flash: Mapping[str, int]
    ram: int


def sizes(folder: Path, machine: Machine) -> Sizes:
    """Link an exported method with the smallest firmware and read its sizes.

    Parameters
    ----------
    folder : Path
        Folder of :func:`learn.embedded.export.export_c`.
    machine : Machine
        A microcontroller.

    Raises
    ------
    ValueError
        If the machine is not a microcontroller, or a tool is not installed.
    RuntimeError
        If the compiler fails; with its message.
    """
    if machine.emulator is None:
        raise ValueError(f"{machine.name} is no microcontroller: take one for sizes in flash and RAM")
    with TemporaryDirectory(prefix="swg-") as out:
        objects = compile_objects(folder, machine, Path(out), "size.c")
        listing = Path(out) / "map"
        options = ("--specs=nosys.specs", "-Wl,--entry=firmware", f"-Wl,-Map={listing}")
        link(objects, machine, Path(out) / "firmware", *options)
        placed = _placed(listing.read_text())
    flash = Counter[str]()
    for (section, owner), size in placed.items():
        if section.startswith(IN_FLASH) and owner != "size":
            flash[owner] += size
    return Sizes(dict(flash), sum(size for (section, _), size in placed.items() if section.startswith(IN_RAM)))


def _placed(listing: str) -> Counter[tuple[str, str]]:
    """Bytes by section and the file that it came from, of a GNU linker's map."""
    kept = listing.partition("Linker script and memory map")[2]
    on_one_line = re.sub(r"^( \S+)\n +0x", r"\1 0x", kept, flags=re.MULTILINE)
    placed = Counter[tuple[str, str]]()
    for section, size, path in PLACED.findall(on_one_line):
        placed[section, _owner(path)] += int(size, 16)
    return placed


def _owner(path: str) -> str:
    """A file's or library's name: forest of /folder/forest.o, libm of /folder/libm.a(member.o)."""
    return Path(path.partition("(")[0]).stem
