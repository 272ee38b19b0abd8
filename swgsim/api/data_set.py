"""Data sets and virtual recordings by the choices of ``conf/``, without the command line."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hydra import compose, initialize_config_dir

from swgsim.common.configured import conf_folder, plain
from swgsim.effects import Effect
from swgsim.effects.text import entries
from swgsim.jobs import generate_data_set, record_on_bench


def _composed(command: str, choices: Sequence[str]) -> dict[str, Any]:
    with initialize_config_dir(str(conf_folder()), version_base="1.3"):
        return plain(compose(command, list(choices)))


def generate(
    grid: str = "small", condition: str = "clean", data: str | Path = "data", choices: Sequence[str] = ()
) -> Path:
    """Generate a labelled data set, as the command ``swg generate`` does; one that is there already is kept.

    Parameters
    ----------
    grid : str
        A name of ``conf/grid``: "small", "paper", "sampled" and others.
    condition : str
        A name of ``conf/condition``: "clean", "disturbed", "bench" and others.
    data : str or Path
        Folder of the file.
    choices : sequence of str
        Further choices in Hydra's syntax, such as ["window=long", "grid.variants=4"].

    Returns
    -------
    Path
        An HDF5 file laid out as NetCDF-4, which xarray and :func:`learn.load` read.
    """
    config = _composed("generate", [f"grid={grid}", f"condition={condition}", *choices])
    return Path(generate_data_set.run(config | {"data": str(data)})["path"])


def record(folder: str | Path, *hidden: Effect, seed: int = 1, choices: Sequence[str] = ()) -> Path:
    """Record a gear on the virtual test bench, as the command ``swg record`` does.

    Parameters
    ----------
    folder : str or Path
        Folder to make; the truth is kept beside it as ``<folder>.truth.json``.
    hidden : Effect
        Effects that act in the recordings and that nothing in the folder declares.
    seed : int
        Of the errors of the bench.
    choices : sequence of str
        Further choices in Hydra's syntax, such as ["sessions.repeats=2", "speeds_rpm=[2000]"].

    Returns
    -------
    Path
        The folder, which :func:`swgsim.read_recordings` reads.

    Raises
    ------
    ValueError
        If the folder is there already.
    """
    config = _composed("record", choices)
    return Path(record_on_bench.run(config | {"out": str(folder), "hidden": entries(hidden), "seed": seed})["path"])
