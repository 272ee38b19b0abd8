"""Closing the loop: the physical effect that explains the residual between model and measurement.

``data`` prepares measurements, ``covariance`` and ``fit`` hold the statistics, ``commissioning`` learns the healthy
gear, ``search`` proposes effects, ``decide`` accepts them, ``interharmonics`` treats lines between the orders,
``report`` writes.
Imports ``bench``, ``chain``, ``recordings`` and rooms below these; robot joints (``joint``) do not need it.
"""

from swgsim.identification.commissioning.commissioning import commission
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.answer import Answer, answer

__all__ = [
    "Answer",
    "Measured",
    "Model",
    "Unit",
    "answer",
    "commission",
]
