"""
An effect of one's own
======================

Each physical effect of the library is one class, which says where it acts and what it changes. A class of your own is
simulated like them, and ``swg close-loop`` with ``library=[my_module:CableDrag]`` searches for it as well. Here a
voltage is induced in the cable of gauge s1: the signal gains a part in proportion to the speed of the input.
"""

from dataclasses import dataclass

import numpy as np

import swgsim as swg
from swgsim.effects.base import Scene, Signals
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class CableDrag(swg.effects.Effect):
    """A voltage is induced in the cable of gauge s1 in proportion to the input's speed.

    Attributes
    ----------
    gain : float
        Signal per speed [mV/V per rad/s].
    """

    place = "gauge"
    gain: float = size(unit="mV/V per rad/s", low=-1e-3, high=1e-3, typical=1e-5)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """Act on the signals of the gauges s0 to s4, array (5, time)."""
        speed = np.gradient(scene.phi_in, scene.time)
        changed = signals.copy()
        changed[1] += self.gain * speed
        return changed


# %%
gear, point = swg.Gear(), swg.OperatingPoint(n_in_rpm=2000, T_out=39)
dragged = swg.simulate(gear, point, CableDrag(2e-5))
figure = dragged.plot(compare=swg.simulate(gear, point))
shift = (dragged.signals - swg.simulate(gear, point).signals).mean(axis=1)
print("mean shift of s0 to s4 [mV/V]:", shift.round(5))
