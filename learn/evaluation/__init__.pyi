from .bootstrap import gear_bootstrap, paired_comparison
from .evaluate import Evaluation, evaluate
from .importance import Predictor
from .probability_calibration import expected_calibration_error, reliability
from .selective import risk_coverage

__all__ = [
    "Evaluation",
    "Predictor",
    "evaluate",
    "expected_calibration_error",
    "gear_bootstrap",
    "paired_comparison",
    "reliability",
    "risk_coverage",
]
