from .adaptations import ADAPTATIONS
from .adapting import Adapted, adapt_and_judge
from .transfer import Adaptation

__all__ = [
    "ADAPTATIONS",
    "Adaptation",
    "Adapted",
    "adapt_and_judge",
]
