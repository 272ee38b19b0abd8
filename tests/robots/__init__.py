"""Recordings of virtual robot joints that share no code and no form of friction with the package.

They ask two questions: how often an effect is named that no joint has (kind ``healthy``), and what is answered to one
piece of physics that the package was not made for (:data:`robots.draw.FOREIGN`).

- :mod:`robots.plant`: motor, gear, spring and link under control; sharp or LuGre friction; implicit steps.
- :mod:`robots.draw`: a joint of random size, with the sources of all ranges.
- :mod:`robots.trajectories`: how people move a joint to record it.
- :mod:`robots.campaign`: days of recordings with encoder, drive, sensors and noise.
- ``python tests/robots``: asks the identification and counts.
"""

from robots.campaign import Campaign, joint
from robots.draw import FOREIGN, KINDS, Truth

__all__ = ["FOREIGN", "KINDS", "Campaign", "Truth", "joint"]
