from .contract import Classifier, require_contract
from .flat_forest import FlatForest
from .networks import Network
from .neural import NeuralClassifier
from .rocket import MiniRocket
from .training import Recipe, train

__all__ = [
    "Classifier",
    "FlatForest",
    "MiniRocket",
    "Network",
    "NeuralClassifier",
    "Recipe",
    "require_contract",
    "train",
]
