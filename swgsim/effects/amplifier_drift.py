from dataclasses import dataclass

from swgsim.effects.base import Channels, Effect, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import on_gauges, since_session


@dataclass(frozen=True)
class AmplifierDrift(Effect):
    """The gain of all bridges, zeros included, drifts in proportion to the time since the session began.

    The source is physics.md AC6.

    Signature: the mean and all orders of all gauges change by the same share. The share grows with time and does not
    depend on load or speed. Typical: 0.02 to 0.1 % while the amplifier warms up by 10 K, in an hour (an estimate).

    Attributes
    ----------
    rate : float
        [1/h], from -0.02 to 0.02 (beyond, no calibration would hold for a session).
    """

    place = "acquisition"
    rate: float = size(unit="1/h", low=-0.02, high=0.02, typical=5e-4)

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """The channels with the gauges scaled."""
        gain = 1 + self.rate * since_session(scene) / 3600
        return on_gauges(channels, lambda _, signal: gain * signal)
