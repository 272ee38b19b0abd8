"""Identification (closing the loop): the physical effects that explain the residual between model and measurement.

``data`` prepares measurements, ``covariance`` and ``fit`` hold the statistics, ``commissioning`` learns the healthy
gear, ``search`` proposes effects, ``decide`` accepts them, ``interharmonics`` treats interharmonic lines, ``report``
writes; ``identify`` has the two calls.
Imports ``bench``, ``chain``, ``recordings`` and rooms below these; robot joints (``joint``) do not need it.
"""

from swgsim.identification.fit.unit import Unit
from swgsim.identification.identify import Identification, commission, identify

__all__ = ["Identification", "Unit", "commission", "identify"]
