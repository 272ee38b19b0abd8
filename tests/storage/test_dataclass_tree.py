"""Dataclasses in HDF5: what is read is what was written, and nothing else is taken."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pytest
from jaxtyping import Bool, Complex, Float

from swgsim.storage.dataclass_tree import Notation, Room, layout_of, read_member, write_member


class Metal:
    def __init__(self, name: str) -> None:
        self.name = name

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Metal) and self.name == other.name


METAL = (Notation(Metal, lambda metal: metal.name, Metal),)


@dataclass(frozen=True)
class Bolt:
    length: float = 0.1
    metal: Metal = field(default_factory=lambda: Metal("steel"))


@dataclass(frozen=True, eq=False)
class Rig:
    name: str
    count: int
    ready: bool
    bolts: tuple[Bolt, ...]
    pair: tuple[str, float]
    modes: Mapping[str, Complex[np.ndarray, " mode"]]
    reach: Float[np.ndarray, "one other"]
    kept: Bool[np.ndarray, " one"] | None = None
    spare: Bolt | None = None


def rig() -> Rig:
    modes = {"z, last": np.array([1j, 0.1]), "a first": np.array([], complex)}
    bolts = (Bolt(1 / 3), Bolt(5e-324, Metal("brass")), *[Bolt()] * 10)
    return Rig("Ä", 7, True, bolts, ("a", -0.0), modes, np.arange(6.0).reshape(2, 3).T, np.array([True, False]))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    write(tmp_path / "rig.h5", rig())
    return tmp_path / "rig.h5"


def write(path: Path, value: Rig) -> None:
    with h5py.File(path, "w") as file:
        write_member(file, "rig", value, Rig, METAL)


def read(path: Path) -> Rig:
    with h5py.File(path) as file:
        return read_member(file, "rig", Rig, Room(path.stat().st_size), METAL)


def test_everything_is_read_as_it_was_written(path: Path) -> None:
    written, found = rig(), read(path)
    for name in ("name", "count", "ready", "bolts", "pair", "spare"):
        assert getattr(found, name) == getattr(written, name)
    assert list(found.modes) == list(written.modes)
    for one, other in ((found.reach, written.reach), (found.kept, written.kept), (found.modes, written.modes)):
        np.testing.assert_equal(one, other)
    # Matrix products round by the order in memory.
    assert found.reach.flags.f_contiguous
    assert found.ready is True
    assert np.signbit(found.pair[1])


def test_the_same_value_has_the_same_bytes(path: Path, tmp_path: Path) -> None:
    write(tmp_path / "again.h5", read(path))
    assert (tmp_path / "again.h5").read_bytes() == path.read_bytes()


def _change(name: str, value: object) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file["rig"][name]
        file["rig"][name] = value

    return change


def _links(file: h5py.File) -> None:
    del file["rig/modes/a first"]
    for number in range(2_000):
        file[f"rig/modes/{number}"] = file["rig/modes/z, last"]


SPOILED: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "missing": (lambda file: file["rig"].attrs.__delitem__("count"), "rig.count: found nothing, expected int"),
    "unknown": (lambda file: file["rig"].attrs.create("more", 1.0), "rig: found 'more', expected one of name, count"),
    "text": (lambda file: file["rig"].attrs.create("count", 0.5), "rig.count: found '0.5', expected int"),
    "number": (lambda file: file["rig"].attrs.create("name", 3), "rig.name: found 3, expected str"),
    "nan": (lambda file: file["rig/bolts/1"].attrs.create("length", np.nan), "rig.bolts.1.length: found 'nan'"),
    "bool": (lambda file: file["rig"].attrs.create("ready", 2), "rig.ready: found '2', expected bool"),
    "axes": (_change("reach", np.zeros(3)), "rig.reach: found float64 of shape (3,), expected Float[ndarray, 'one"),
    "type": (_change("kept", np.zeros(3)), "rig.kept: found float64 of shape (3,), expected Bool[ndarray"),
    "not finite": (_change("reach", np.full((2, 2), np.inf)), "rig.reach: found a value that is not finite"),
    "objects": (_change("reach", "text"), "rig.reach: found object of shape ()"),
    "gap": (lambda file: file["rig/bolts"].move("3", "30"), "rig.bolts: found members 0, 1, 2, 4"),
    "pair": (lambda file: file["rig/pair"].attrs.create("2", 1.0), "rig.pair: found 3 members, expected 2"),
    "link": (_change("reach", h5py.SoftLink("/rig/modes/z, last")), "rig.reach: found no variable of the file itself"),
    "outside": (_change("modes", h5py.ExternalLink("b.h5", "/")), "rig.modes: found no group of the file itself"),
    "array": (_change("bolts", np.zeros(3)), "rig.bolts: found no group of the file itself, expected tuple["),
    "many": (_links, "more numbers than the file has room for"),
}


@pytest.mark.parametrize("name", list(SPOILED))
def test_what_is_not_expected_is_refused_with_field_and_finding(name: str, path: Path) -> None:
    spoil, message = SPOILED[name]
    with h5py.File(path, "a") as file:
        spoil(file)
    if name == "many":  # room as in a file of the few numbers that it really has
        with h5py.File(path) as file, pytest.raises(ValueError, match=message):
            read_member(file, "rig", Rig, Room(2_000), METAL)
        return
    with pytest.raises(ValueError, match=re.escape(message)):
        read(path)


def test_a_filled_array_does_not_fill_the_memory(path: Path) -> None:
    with h5py.File(path, "a") as file:
        del file["rig/reach"]
        file["rig"].create_dataset("reach", (10**6, 10**6), "f8", chunks=(10, 10))
    with pytest.raises(ValueError, match=r"rig\.reach: found more numbers than the file has room for"):
        read(path)


def test_the_layout_is_that_of_the_fields() -> None:
    @dataclass(frozen=True)
    class Longer(Bolt):
        width: float = 0.0

    @dataclass(frozen=True)
    class Optional(Bolt):
        length: float | None = None

    layouts = [layout_of(kind, METAL) for kind in (Bolt, Longer, Optional, Rig)]
    assert len(set(layouts)) == 4
    assert layouts == [layout_of(kind, METAL) for kind in (Bolt, Longer, Optional, Rig)]


def test_values_without_a_form_are_refused_while_writing(tmp_path: Path) -> None:
    @dataclass(frozen=True)
    class Odd:
        call: Callable

    with h5py.File(tmp_path / "a.h5", "w") as file, pytest.raises(TypeError, match="has no form in a file"):
        write_member(file, "odd", Odd(print), Odd)
