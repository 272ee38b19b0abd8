from dataclasses import dataclass

from swgsim.effects.base import Effect, Field, Psi, Theta
from swgsim.effects.quantity import size


@dataclass(frozen=True)
class WornWaveGenerator(Effect):
    """Wear between wave generator and sleeve takes a share of the deflection w0 (physics.md AG4).

    Signature: orders 2 and 4 of the deflection fall, equally in opposite gauges, at any load, speed and temperature. A
    gear whose w0 is fitted cannot show it, because a smaller w0 is the same. Typical: 2 % (estimate).

    Attributes
    ----------
    loss : float
        Share of w0 that is lost, from 0 to 0.3.
    """

    place = "wave generator"
    loss: float = size(unit="-", low=0, high=0.3, typical=0.02)

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """What is left of the displacement."""
        return displacement * (1 - self.loss)
