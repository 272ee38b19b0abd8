"""Physical effects that change the chain at a known place, one file each; the five faults of Table I are among them.

:data:`LIBRARY` lists them by their names in files, such as ``root_tooth_crack``.
"""

from swgsim.effects.base import Crack, Effect
from swgsim.effects.library import *  # noqa: F403 - every effect by its class
from swgsim.effects.library import LIBRARY, SEARCHED, named

__all__ = ["LIBRARY", "SEARCHED", "Crack", "Effect", "named"]
__all__ += sorted(kind.__name__ for kind in LIBRARY.values())
