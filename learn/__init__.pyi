from .api.choices import classifier
from .api.data import load
from .api.evaluate import Scores, evaluate
from .inputs.inputs import LearningSet

__all__ = ["LearningSet", "Scores", "classifier", "evaluate", "load"]
