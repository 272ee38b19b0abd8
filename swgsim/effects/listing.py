"""The list of the library, as the command ``swg effects`` prints it."""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Any

from swgsim.effects.library import LIBRARY


def run(config: Mapping[str, Any]) -> None:
    """Print name and first sentence of every effect whose name fits the pattern ``only``.

    >>> run({"only": "*tooth_crack"})
    root_tooth_crack  A crack at the root of a tooth: the stiffness between two neighbouring columns of nodes falls.
    tip_tooth_crack   The tip of a tooth is cracked or gone, so its force F_tooth falls strongly.

    Raises
    ------
    ValueError
        If no name fits.
    """
    chosen = [name for name in sorted(LIBRARY) if fnmatchcase(name, str(config["only"]))]
    if not chosen:
        raise ValueError(f"only={config['only']} fits none of the {len(LIBRARY)} effects: try only='*friction*'")
    width = max(map(len, chosen))
    for name in chosen:
        print(f"{name:{width}}  {' '.join((LIBRARY[name].__doc__ or '').split()).partition('. ')[0].rstrip('.')}.")
