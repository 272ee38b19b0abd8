"""What lies around the bytes of a file, and is made sound again after they were spoiled: else only it were tried."""

import gzip
import hashlib
import io
import zipfile
import zlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from swgsim.storage.storage import SEAL_SIZE, SEAL_START

Change = Callable[[bytes], bytes]
LARGEST_INSIDE = 2**24


class Wrapping(NamedTuple):
    """Spoils the inside of a file and wraps it anew."""

    change: Callable[[bytes, Change, np.random.Generator], bytes]


def _plain(content: bytes, change: Change, rng: np.random.Generator) -> bytes:
    return change(content)


def sealed(body: bytes) -> bytes:
    """A file with the seal of :mod:`swgsim.storage.storage` around any bytes, as anybody can write it."""
    seal = SEAL_START + hashlib.sha256(body).hexdigest().encode() + b"\n"
    return seal.ljust(SEAL_SIZE, b" ") + body


def _seal(content: bytes, change: Change, rng: np.random.Generator) -> bytes:
    return sealed(change(content[SEAL_SIZE:]))


def _gzip(content: bytes, change: Change, rng: np.random.Generator) -> bytes:
    try:
        inside = zlib.decompressobj(31).decompress(content, LARGEST_INSIDE)
    except zlib.error:
        return change(content)
    return gzip.compress(change(inside), 1)


def _zip(content: bytes, change: Change, rng: np.random.Generator) -> bytes:
    """One member of an archive, with sums that agree."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = {info.filename: archive.read(info) for info in archive.infolist()}
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, ValueError):
        return change(content)
    if not members:
        return change(content)
    chosen = str(rng.choice(sorted(members)))
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name, inside in members.items():
            archive.writestr(name, change(inside) if name == chosen else inside)
    return made.getvalue()


PLAIN, SEALED, GZIPPED, ZIPPED = map(Wrapping, (_plain, _seal, _gzip, _zip))
