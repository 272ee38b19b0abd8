from .features import Selection, signal_quantities
from .harmonics import Harmonics
from .inputs import LearningSet, Representation
from .lines import ResidualLines
from .references import healthy_reference
from .rows import Inputs
from .signals import Signals

__all__ = [
    "Harmonics",
    "Inputs",
    "LearningSet",
    "Representation",
    "ResidualLines",
    "Selection",
    "Signals",
    "healthy_reference",
    "signal_quantities",
]
