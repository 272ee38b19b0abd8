"""Ways to spoil a file: of any bytes, and of text with numbers in it."""

import re
from collections.abc import Callable

import numpy as np

# Where readers of numbers, names and trees go wrong.
NUMBERS = (
    b"nan", b"inf", b"-inf", b"1e400", b"-1e308", b"1e-320", b"0", b"-1", b"9" * 400, b"1" * 20_000 + b"x", b"0x1p3",
    b"1_0", b"1,5", b"", b"true", b"null", b"\xef\xbc\x91", b"4294967296", b"18446744073709551616", b".5.", b"1e",
    b"12:30", b"2001-13-45",
)  # fmt: skip
WORDS = (
    b"../../etc/passwd", b"/etc/passwd", b"C:\\x", b"a\x00b", b"\xff\xfe", b"\r", b"\n\n", b'"', b"'", b"[" * 3000,
    b"{a: " * 300, b"!!python/object/apply:os.system ['true']", b"&a [*a]", b"*a", b"<<: {}", b"- ", b"? ", b"|", b"%",
    b"x" * 5000, b"\xe2\x80\xae", b";", b"\t", b"#", b"__class__", b"os:system", b"antigravity:x",
)  # fmt: skip
INTERESTING = (
    0,
    1,
    0x7F,
    0x80,
    0xFF,
    0x7FFF,
    0xFFFF,
    0x7FFFFFFF,
    0xFFFFFFFF,
    0x7FFFFFFFFFFFFFFF,
    2**64 - 1,
    50_000_000,
)
LARGEST = 2**20

Way = Callable[[bytes, np.random.Generator], bytes]


def _at(content: bytes, rng: np.random.Generator) -> int:
    return int(rng.integers(len(content) + 1))


def bits(content: bytes, rng: np.random.Generator) -> bytes:
    """Up to 8 bits turned."""
    raw = bytearray(content)
    for where in rng.integers(max(len(raw), 1), size=rng.integers(1, 9)) if raw else ():
        raw[where] ^= 1 << int(rng.integers(8))
    return bytes(raw)


def cut(content: bytes, rng: np.random.Generator) -> bytes:
    """The end or a middle part is missing."""
    start = _at(content, rng)
    return content[:start] + (content[start + int(rng.integers(1, 200)) :] if rng.random() < 0.5 else b"")


def splice(content: bytes, rng: np.random.Generator) -> bytes:
    """A part stands at another place, too or instead."""
    start, to = _at(content, rng), _at(content, rng)
    part = content[start : start + int(rng.integers(1, 2000))]
    return content[:to] + part + content[to + len(part) * int(rng.integers(2)) :]


def head_twice(content: bytes, rng: np.random.Generator) -> bytes:
    """The beginning is there twice."""
    size = int(rng.choice([8, 64, 512, max(content.find(b"\n") + 1, 1)]))
    return content[:size] + content


def word(content: bytes, rng: np.random.Generator) -> bytes:
    """A whole number of 2 to 8 bytes is an extreme one, where most of them are: at an even place."""
    size = int(rng.choice([2, 4, 8]))
    where = _at(content, rng) // 2 * 2
    value = int(rng.choice(np.array(INTERESTING, dtype=object))) % 256**size
    return content[:where] + value.to_bytes(size, "little") + content[where + size :]


def number(content: bytes, rng: np.random.Generator) -> bytes:
    """A number in a text is another one, or none."""
    found = list(re.finditer(rb"[0-9.eE+-]+", content[:200_000]))
    if not found:
        return content
    chosen = found[int(rng.integers(len(found)))]
    return content[: chosen.start()] + NUMBERS[int(rng.integers(len(NUMBERS)))] + content[chosen.end() :]


def put(content: bytes, rng: np.random.Generator) -> bytes:
    """A word of harm stands somewhere, or in place of a name."""
    found = [match.span() for match in re.finditer(rb"[A-Za-z_][\w.]*", content[:200_000])]
    start, end = found[int(rng.integers(len(found)))] if found and rng.random() < 0.5 else (_at(content, rng),) * 2
    return content[:start] + WORDS[int(rng.integers(len(WORDS)))] + content[end:]


def lines(content: bytes, rng: np.random.Generator) -> bytes:
    """A line is missing, twice or elsewhere."""
    rows = content.splitlines(keepends=True)
    if not rows:
        return content
    row = rows.pop(int(rng.integers(len(rows))))
    for _ in range(int(rng.integers(3))):
        rows.insert(int(rng.integers(len(rows) + 1)), row)
    return b"".join(rows)


BINARY: tuple[Way, ...] = (bits, bits, cut, splice, head_twice, word, word)
TEXT: tuple[Way, ...] = (bits, cut, splice, head_twice, number, number, put, put, lines)


def spoiled(content: bytes, ways: tuple[Way, ...], rng: np.random.Generator) -> bytes:
    """The content after one to four changes."""
    for _ in range(int(rng.integers(1, 5))):
        content = ways[int(rng.integers(len(ways)))](content, rng)[:LARGEST]
    return content
