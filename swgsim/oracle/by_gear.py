"""Jobs that judge the recordings of a data set gear by gear, each in a part from which a killed run resumes."""

import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import yaml
from tqdm import tqdm

from swgsim.common.compute import Engine
from swgsim.common.files import replacing, sole_maker
from swgsim.common.version import code_version
from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear
from swgsim.jobs import settings
from swgsim.storage import storage
from swgsim.storage.labelled_signals import LabelledSignals


def data_set(config: Mapping[str, Any]) -> Path:
    """The data set that ``data``, ``grid`` and ``condition`` name."""
    return Path(config["data"]) / f"{config['grid']['name']}-{config['condition']['name']}.h5"


def configuration_of(source: Path) -> dict[str, Any]:
    """The choices with which a data set was made.

    Raises
    ------
    ValueError
        If it is missing or was made by other code.
    """
    if not source.is_file():
        grid, condition = source.stem.rsplit("-", 1)
        raise ValueError(f"no data set {source}; make it with 'swg generate grid={grid} condition={condition}'")
    found = storage.attributes(source)
    if found["swgsim"] != code_version():
        raise ValueError(
            f"{source} was made by code {found['swgsim']}, while this is {code_version()}, whose gears may differ: "
            "make the data set again with swg generate"
        )
    return dict(yaml.safe_load(found["configuration"]))


def plan_of(source: Path) -> Plan:
    """The plan of a data set; raises like :func:`configuration_of`."""
    return settings.plan(configuration_of(source))


def chosen_gears(plan: Plan, gears: list[int] | None) -> list[int]:
    """Numbers of the gears to judge, in the order of the file.

    Raises
    ------
    ValueError
        If the data set lacks one.
    """
    there = [gear.number for gear in plan.gears]
    missing = set(gears or []) - set(there)
    if missing or gears == []:
        raise ValueError(f"gears is {gears}, the data set has {there}: choose some of them, or null for all")
    return [number for number in there if gears is None or number in gears]


@dataclass(frozen=True)
class GearByGear:
    """A table that is made gear by gear.

    Attributes
    ----------
    plan : Plan
        Of the data set.
    source, path : Path
        Data set and file of the table.
    chosen : list of int
        Numbers of the gears.
    made_from : mapping
        What the table depends on; a file with other values is made again.
    """

    plan: Plan
    source: Path
    path: Path
    chosen: list[int]
    made_from: Mapping[str, Any]

    def table(
        self,
        judged: Callable[..., pd.DataFrame],
        arguments: Callable[[Gear, int, LabelledSignals], tuple[Any, ...]],
        engine: Engine,
    ) -> pd.DataFrame:
        """The table from its file, or made by ``judged`` from the arguments of every gear and written.

        Parameters
        ----------
        judged : callable
            The table of one gear.
        arguments : callable
            What it is given, from the gear, the number of its first sample and its recordings.
        engine : Engine
        """
        attributes = {**self.made_from, "gears": self.chosen}
        found = _kept(self.path, attributes)
        if found is not None:
            print(f"{self.path} is there already, for the same data set, gears, resolution and code")
            return found
        with sole_maker(self.path):
            found = self._made(judged, arguments, engine)
            _keep(self.path, found, attributes)
            shutil.rmtree(self._parts)
        return found

    @property
    def _parts(self) -> Path:
        """Folder of the parts of the file."""
        return self.path.with_name(f".{self.path.name}.parts")

    def _made(
        self,
        judged: Callable[..., pd.DataFrame],
        arguments: Callable[[Gear, int, LabelledSignals], tuple[Any, ...]],
        engine: Engine,
    ) -> pd.DataFrame:
        files = {number: self._parts / f"{number:06d}.parquet" for number in self.chosen}
        parts = {number: part for number, file in files.items() if (part := _kept(file, self.made_from)) is not None}
        left = [number for number in self.chosen if number not in parts]
        tasks = (arguments(*each) for each in self._recordings() if each[0].number in left)
        with tqdm(total=len(self.chosen), initial=len(parts), desc=self.path.stem, unit=" gears") as bar:
            for number, part in zip(left, engine.results(judged, tasks, len(left)), strict=True):
                _keep(files[number], part, self.made_from)
                parts[number] = part
                bar.update()
        return pd.concat([parts[number] for number in self.chosen], ignore_index=True)

    def _recordings(self) -> Iterator[tuple[Gear, int, LabelledSignals]]:
        """Every gear with the number of its first sample and its recordings."""
        first = 0
        for gear, block in zip(self.plan.gears, storage.blocks(self.source, self.plan.grid.count()), strict=True):
            yield gear, first, block
            first += int((~block.table["reference"]).sum())


def _keep(path: Path, table: pd.DataFrame, attributes: Mapping[str, Any]) -> None:
    """Write a table with its attributes; the file is complete or absent."""
    table.attrs = {name: value for name, value in attributes.items()}  # pandas keeps them in the file
    with replacing(path) as aside:
        table.to_parquet(aside, engine="pyarrow", index=False)


def _kept(path: Path, attributes: Mapping[str, Any]) -> pd.DataFrame | None:
    """The table of a file, if it exists and has the same attributes."""
    if not path.exists():
        return None
    try:
        table = pd.read_parquet(path, engine="pyarrow")
    except (OSError, ValueError) as damage:
        print(f"{path}: damaged, made again ({damage})")
        return None
    return table if table.attrs == attributes else None
