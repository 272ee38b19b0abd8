"""Writes a trained method as a folder of C files, which need only a C compiler and its mathematical functions."""

import shutil
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from learn.embedded import forest, network
from learn.embedded.commissioning import gear_source
from learn.embedded.front import front
from learn.embedded.source import Macros, macros
from learn.inputs.inputs import Representation
from swgsim.common.checks import require_known
from swgsim.common.files import remedied
from swgsim.storage.labelled_signals import LabelledSignals

SOURCES = Path(__file__).parent / "c"
NUMBERS = ("float", "int16", "int8")
WRITTEN = {"gear.c", "model.h", "parameters.c", "forest_tables.h"}  # in addition to copies of the sources


def export_c(
    model: Any,
    representation: Representation,
    references: LabelledSignals,
    folder: Path,
    *,
    numbers: str = "float",
    saturation: float = 2.0,
) -> None:
    """Write a trained classifier with its features for one gear; after an error the folder is unchanged.

    Parameters
    ----------
    model : classifier
        A trained forest, logistic regression, perceptron or convolutional network.
    representation : Representation
        The features it was trained on: a selection of Table III, harmonics or residual.
    references : LabelledSignals
        Healthy recordings of the gear at all its operating points.
    folder : Path
        An earlier export in it is replaced.
    numbers : {"float", "int16", "int8"}
        How trained numbers are kept; forests have no int8.
    saturation : float
        Limit of the gauges' amplifiers [mV/V].

    Raises
    ------
    ValueError
        If the method cannot be exported, the references do not fit, or the folder holds other files.
    """
    require_known("numbers", [numbers], NUMBERS)
    folder = free(folder)
    parts = front(representation)
    gear = gear_source(references, parts, saturation)
    with remedied(folder):
        folder.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as aside:
            made = Path(aside) / folder.name
            made.mkdir()
            write = forest.write if forest.is_forest(model) else network.write
            files, sizes = write(model, made, numbers)
            (made / "gear.c").write_text(gear)
            (made / "model.h").write_text(_model_header(model.classes_, {**parts.sizes, **sizes}))
            for name in (*parts.files, *files):
                shutil.copyfile(SOURCES / name, made / name)
            if folder.exists():
                folder.rename(Path(aside) / "before")
            made.rename(folder)


def free(folder: Path) -> Path:
    """A folder's full path; a ValueError if it holds anything that an export did not write."""
    folder = folder.resolve()
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{folder} is a file: choose another folder")
    own = WRITTEN | {path.name for path in SOURCES.iterdir()}
    strange = sorted({path.name for path in folder.iterdir()} - own) if folder.exists() else []
    if strange:
        raise ValueError(f"{folder} holds {strange[0]}, which no export wrote: choose another folder, or empty it")
    return folder


def _model_header(classes: Iterable[Any], sizes: Macros) -> str:
    names = [str(name) for name in classes]
    listed = ", ".join(f'"{name}"' for name in names)
    own = macros({"CLASSES": len(names), "CLASS_NAMES": f"{{{listed}}}", **sizes})
    return f"/* Macros of the exported method. */\n#ifndef SWG_MODEL_H\n#define SWG_MODEL_H\n\n{own}\n#endif\n"
