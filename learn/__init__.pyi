from .api.choices import classifier
from .api.data import load
from .api.evaluate import Scores, evaluate
from .api.transfer import Transfer, transfer
from .inputs.inputs import LearningSet

__all__ = ["LearningSet", "Scores", "Transfer", "classifier", "evaluate", "load", "transfer"]
