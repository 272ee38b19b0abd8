"""Choices of ``conf/`` by their names, with options in place of those of the file."""

from typing import Any

from omegaconf import OmegaConf

from learn.jobs import settings
from learn.methods.classical import Classifier
from swgsim.common.configured import conf_folder


def choice(group: str, name: str, seed: int = 0, **options: Any) -> dict[str, Any]:
    """The resolved values of ``conf/<group>/<name>.yaml``.

    Raises
    ------
    ValueError
        If there is no such file; it lists the names of the group.
    """
    folder = conf_folder() / group
    path = folder / f"{name}.yaml"
    if not path.is_file():
        raise ValueError(
            f"unknown {group} {name!r}; choose from {', '.join(sorted(p.stem for p in folder.glob('*.yaml')))}"
        )
    # The files refer to the seed of the job, which is the root of a configuration.
    whole = OmegaConf.create({"seed": seed, "chosen": OmegaConf.load(path)})
    resolved: dict[str, Any] = OmegaConf.to_container(whole, resolve=True)["chosen"]  # type: ignore[call-overload, index, assignment]
    return resolved | options


def classifier(name: str, seed: int = 0, **options: Any) -> Classifier:
    """An untrained classifier of ``conf/classifier`` with ``fit``, ``predict`` and ``predict_proba``.

    Parameters
    ----------
    name : str
        Such as "rf", "extra_trees" or "mlp".
    seed : int
    options
        In place of those of the file, such as ``trees=300``.

    Examples
    --------
    >>> import learn
    >>> learn.classifier("rf", trees=10)
    RandomForestClassifier(max_depth=7, n_estimators=10, random_state=0)
    """
    return settings.classifier(choice("classifier", name, seed, **options))()
