from .harder_splits import LeaveOperatingPointOut, LeaveSeverityOut
from .levels import Episode, NewGears
from .splits import GroupedFolds, LeaveOneGearOut, RandomFolds, Split, Splitting

__all__ = [
    "Episode",
    "GroupedFolds",
    "LeaveOneGearOut",
    "LeaveOperatingPointOut",
    "LeaveSeverityOut",
    "NewGears",
    "RandomFolds",
    "Split",
    "Splitting",
]
