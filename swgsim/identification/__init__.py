"""Identification (closing the loop): the physical effects that explain the residual between model and measurement.

``data`` prepares measurements, ``covariance`` and ``fit`` hold the statistics, ``commissioning`` learns the healthy
gear, ``interharmonics`` treats interharmonic lines, ``search`` ranks candidates, ``decide`` weighs them by evidence,
``report`` writes; ``calls`` has the two functions for users.
"""

from swgsim.identification.calls import commission, identify
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.identification import Identification

__all__ = ["Identification", "Unit", "commission", "identify"]
