"""Many spoiled files for one reader, and a count of what became of them."""

import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fuzzing.child import attempt
from fuzzing.mutation import spoiled
from fuzzing.targets import TARGETS

KINDS = ("accepted", "refused", "crashed", "hung", "memory", "executed")
HARMLESS = ("accepted", "refused")
BATCH = 25  # readings in one process
MOST_KEPT = 5  # examples of one kind of harm


@dataclass
class Tally:
    """Of one reader: outcomes by kind, harm by its reason, and the most memory of a process that read [byte]."""

    kinds: Counter = field(default_factory=Counter)
    harm: Counter = field(default_factory=Counter)
    memory: int = 0


def campaign(name: str, seconds: float, rng: np.random.Generator, keep: Path | None = None) -> Tally:
    """Spoil and read for so long, at least once.

    Parameters
    ----------
    name : str
        Of :data:`fuzzing.targets.TARGETS`.
    seconds : float
    rng : Generator
    keep : Path, optional
        Where files that did harm are kept.

    Raises
    ------
    RuntimeError
        If the sound files are not accepted.
    """
    target, tally = TARGETS[name], Tally()
    with tempfile.TemporaryDirectory(prefix="fuzz") as scratch:
        place = Path(scratch)
        target.write(place)
        files = sorted(place.glob(target.spoil))
        sound = {file: file.read_bytes() for file in files}
        (outcome,), _ = attempt(target.read, place, files[0], [sound[files[0]]])
        if outcome.kind != "accepted":
            raise RuntimeError(f"{name}: sound files are {outcome.kind}, {outcome.detail}")
        end = time.monotonic() + seconds
        while not tally.kinds or time.monotonic() < end:
            file = files[int(rng.integers(len(files)))]
            contents = [
                target.wrapping.change(sound[file], lambda inside: spoiled(inside, target.ways, rng), rng)
                for _ in range(BATCH)
            ]
            outcomes, memory = attempt(target.read, place, file, contents)
            file.write_bytes(sound[file])
            tally.memory = max(tally.memory, memory)
            for content, outcome in zip(contents, outcomes, strict=False):
                tally.kinds[outcome.kind] += 1
                if outcome.kind not in HARMLESS:
                    reason = f"{outcome.kind}: {outcome.detail}"[:160]
                    tally.harm[reason] += 1
                    if keep is not None and tally.harm[reason] <= MOST_KEPT:
                        keep.mkdir(parents=True, exist_ok=True)
                        number = sum(min(count, MOST_KEPT) for count in tally.harm.values())
                        (keep / f"{number:03d}-{file.name}").write_bytes(content)
    return tally
