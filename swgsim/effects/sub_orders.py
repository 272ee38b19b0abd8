from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import choice, random_phase, size
from swgsim.effects.turns import on_gauges


@dataclass(frozen=True)
class SubOrders(Effect):
    """One line of the disturbance of eq. (10): every gauge gains a_j sin(phi_in / j + alpha_j).

    The phases differ in every gauge and recording. The paper also draws the amplitudes; here they are the size. The
    cage of the wave generator's bearing, at order 0.45 to 0.46, is near j = 2 (physics.md FS11).

    Signature: order 1 / j in all gauges, without a pattern, at all loads and speeds. Typical: 0.1 to 1 % of order 2.

    Attributes
    ----------
    j : int
        From 2 to 4; one revolution holds one j-th of a cycle.
    amplitude : float
        [mV/V], from 0 to 0.05 (a quarter of order 2).
    phase_0, phase_1, phase_2, phase_3, phase_4 : float
        Of each sensor at phi_in = 0 [rad].
    """

    place = "acquisition"
    j: int = choice(low=2, high=4)
    amplitude: float = size(unit="mV/V", low=0, high=0.05, typical=5e-4)
    phase_0: float = random_phase()
    phase_1: float = random_phase()
    phase_2: float = random_phase()
    phase_3: float = random_phase()
    phase_4: float = random_phase()

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the line on the gauges."""
        phases = (self.phase_0, self.phase_1, self.phase_2, self.phase_3, self.phase_4)
        return on_gauges(
            channels, lambda s, signal: signal + self.amplitude * np.sin(scene.phi_in / self.j + phases[s])
        )
