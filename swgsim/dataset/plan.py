"""The plan of a data set: everything that determines its recordings, in blocks of bounded size."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from math import ceil

from swgsim.bench.scatter import Bench, Session
from swgsim.chain.chain import SECTORS
from swgsim.common.seeds import generator
from swgsim.common.version import code_version
from swgsim.dataset.grid import Case, Grid
from swgsim.effects.base import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear

# Recordings per block: it bounds the memory for any grid, and splits the paper's grid evenly over cores.
BLOCK = 1140
# Longest window [samples] with so many recordings per block; blocks of longer windows have fewer.
BLOCK_SAMPLES = 600


@dataclass(frozen=True)
class Plan:
    """Everything that determines the recordings of a data set.

    Attributes
    ----------
    gears : tuple of Gear
    grid : Grid
    window : Window
    bench : Bench or None
        Errors of a test bench, if any.
    sectors : int
        Sectors of the flex spline's truss.
    effects : tuple of Effect
        Declared effects of every run, in addition to its fault.
    configuration : str
        Configuration as text; it is written to the file.
    """

    gears: tuple[Gear, ...]
    grid: Grid
    window: Window
    bench: Bench | None = None
    sectors: int = SECTORS
    effects: tuple[Effect, ...] = ()
    configuration: str = ""

    def __post_init__(self) -> None:
        numbers = [gear.number for gear in self.gears]
        if not numbers:
            raise ValueError("no gears: the grid is empty, choose at least one")
        if len(set(numbers)) < len(numbers):
            raise ValueError(f"gear numbers {numbers} are not distinct: every gear needs a number of its own")

    def __len__(self) -> int:
        return len(self.gears) * self.grid.count()

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of the file; a run resumes only from parts with equal attributes."""
        return provenance(self.configuration)

    def session(self, gear: Gear, reference: bool = False, day: int = 0) -> Session:
        """Biases of the torque flanges in the session of a gear's references, or of its other recordings on a day.

        Raises
        ------
        ValueError
            If the plan has no bench.
        """
        if self.bench is None:
            raise ValueError("the plan has no bench, so there are no biases of flanges: choose condition=bench")
        further = (day,) if day else ()
        return self.bench.session(generator("session", self.grid.seed, gear.number, reference, *further))

    @property
    def block_count(self) -> int:
        """Number of blocks; a block holds recordings of one gear."""
        return len(self.gears) * ceil(self.grid.count() / block_size(self.window.samples))

    def blocks(self) -> Iterator[list[Case]]:
        """The planned recordings, block by block."""
        for gear in self.gears:
            cases = self.grid.cases(gear)
            while block := list(islice(cases, block_size(self.window.samples))):
                yield block


def block_size(samples: int) -> int:
    """Recordings per block for a window of ``samples``."""
    return max(1, min(BLOCK, BLOCK * BLOCK_SAMPLES // samples))


def provenance(configuration: str) -> dict[str, str]:
    """Configuration and version of the code, as attributes of a file."""
    return {"configuration": configuration, "swgsim": code_version()}
