from dataclasses import dataclass

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.quantity import size
from swgsim.flexspline.gauges import waves


@dataclass(frozen=True)
class BoltPreload(Effect):
    """Unequally tightened bolts or an uneven seat leave a static strain field of two waves around the collar.

    Bolts that are tightened crosswise do this (physics.md SE18). At four gauges the field is one number, whatever its
    direction. Fields of one and of three waves are the tilting moment.

    Signature: equal means in opposite gauges and opposite means in neighbours, at all loads and speeds. Neither s0 nor
    any order changes. The field changes when the gear is assembled again. Typical: 5 to 50 um/m, 0.0025 to 0.025 mV/V.

    Attributes
    ----------
    strain : float
        On s1 and s3 [mV/V], from -0.1 to 0.1 (200 um/m; beyond, the collar is bent).
    """

    place = "gauge"
    strain: float = size(unit="mV/V", low=-0.1, high=0.1, typical=0.01)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals with the offsets of two waves around the collar."""
        return signals + self.strain * waves(2).real
