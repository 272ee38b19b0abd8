"""A data set as inputs for classifiers."""

from pathlib import Path
from typing import Any

from learn.api.choices import choice
from learn.inputs.inputs import LearningSet
from learn.jobs import settings
from learn.jobs.train_job import learning_set_of
from swgsim.storage import storage


def load(path: str | Path, features: str = "selection_3", **options: Any) -> LearningSet:
    """Read a data set of ``swg generate`` and compute its inputs.

    Parameters
    ----------
    path : str or Path
        Such as "data/paper-clean.h5".
    features : str
        A name of ``conf/features``: "selection_1" to "selection_3" (Table III), "harmonics", "raw", "residual" ...
    options
        In place of those of the file, such as ``orders=12``.

    Returns
    -------
    LearningSet
        ``features`` (sample, feature) and ``table``, a DataFrame of facts with the columns ``label``, ``gear``,
        ``variant``, ``severity``, ``n_in_rpm``, ``T_out_nm`` and others.

    Raises
    ------
    ValueError
        If the file is missing or damaged, or a name is unknown.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"no data set {path}: make one with 'swg generate grid=small condition=clean'")
    return learning_set_of(path, storage.digest(path), settings.representation(choice("features", features, **options)))
