"""Many kills of one piece of work, and a count of what became of it."""

import shutil
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from chaos.killing import KILLED, attempt
from chaos.subjects import Subject


@dataclass
class Tally:
    """Kills by the phase in which they fell, works that were begun, and what was wrong at their ends, with reasons."""

    phases: Counter = field(default_factory=Counter)
    works: int = 0
    lost: Counter = field(default_factory=Counter)
    differing: Counter = field(default_factory=Counter)

    @property
    def kills(self) -> int:
        """All of them."""
        return self.phases.total()


def campaign(subject: Subject, kills: int, seconds: float, rng: np.random.Generator, place: Path) -> Tally:
    """Do the work undisturbed, then again and again with kills at moments drawn over the time that it took.

    Parameters
    ----------
    subject : Subject
    kills : int
        After so many, or so many seconds, the work that was begun is let go to its end.
    seconds : float
    rng : Generator
    place : Path
        An empty folder.

    Raises
    ------
    RuntimeError
        If the undisturbed work fails.
    """
    tally, log, undisturbed = Tally(), place / "log", place / "undisturbed"
    undisturbed.mkdir()
    start = time.monotonic()
    if attempt(lambda: subject.work(undisturbed), None, log):
        raise RuntimeError(f"the undisturbed work failed: {log.read_text()[-2000:]}")
    duration = time.monotonic() - start
    expected = subject.result(undisturbed)
    while tally.kills < kills and time.monotonic() < start + seconds:
        folder = place / f"work-{tally.works}"
        folder.mkdir()
        tally.works += 1
        status = KILLED
        while status == KILLED:
            go_on = tally.kills < kills and time.monotonic() < start + seconds
            status = attempt(lambda: subject.work(folder), rng.uniform(0, duration) if go_on else None, log)  # noqa: B023
            if status == KILLED:
                tally.phases[subject.phase(folder)] += 1
        if status:
            tally.lost[f"does not start again: {log.read_text()[-500:]}"] += 1
        else:
            _compare(expected, subject.result(folder), tally)
        shutil.rmtree(folder)
    return tally


def _compare(expected: dict, found: dict, tally: Tally) -> None:
    """Count what is missing and what is not the same or too much."""
    for name in expected.keys() | found.keys():
        if name not in found:
            tally.lost[f"{name} is missing"] += 1
        elif name not in expected or found[name] != expected[name]:
            tally.differing[f"{name} is not the same" if name in expected else f"{name} is left over"] += 1
