from .adaptations import ADAPTATIONS
from .adapted import Adapted
from .adapting import adapt_and_judge
from .transfer import Adaptation

__all__ = [
    "ADAPTATIONS",
    "Adaptation",
    "Adapted",
    "adapt_and_judge",
]
