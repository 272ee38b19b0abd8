"""Library effects with another form than in the library, as real ones have."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import choice, phase, quantities, size, size_of
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.storage.labelled_signals import SENSORS

# A size that is nothing only so many times beyond its typical value is a level that something reaches.
LEVEL = 10.0
# Load at which another law in the load changes nothing [N m].
MIDDLE_LOAD = 39.0


@dataclass(frozen=True)
class Alteration:
    """How the size of an effect varies over operating points, where the library has one size for all.

    Attributes
    ----------
    exponent : float
        The size goes with (T_out / 39 N m) to this power, beside the effect's own law.
    spread : float
        Standard deviation of a relative change from one operating point to the next.
    speed, load, phase : float
        The wave that this change follows over speed [1/rpm] and load [1/(N m)], and its phase [rad].
    """

    exponent: float = 0.0
    spread: float = 0.0
    speed: float = 0.0
    load: float = 0.0
    phase: float = 0.0

    @classmethod
    def scattered(cls, spread: float, rng: np.random.Generator) -> "Alteration":
        """Another size at every operating point."""
        return cls(0.0, spread, rng.uniform(5e-4, 5e-3), rng.uniform(0.02, 0.2), rng.uniform(0, 2 * np.pi))

    def factor(self, point: OperatingPoint) -> float:
        """By which the size differs at an operating point."""
        wave = np.cos(self.speed * point.n_in_rpm + self.load * point.T_out + self.phase)
        law = (max(abs(point.T_out), 1e-3) / MIDDLE_LOAD) ** self.exponent
        return float(law * (1 + np.sqrt(2) * self.spread * wave))


@dataclass(frozen=True)
class Altered(Effect):
    """An effect whose size is another one at every operating point."""

    effect: Effect
    alteration: Alteration

    def at(self, point: OperatingPoint, conditions: Conditions) -> Effect:
        """The effect itself, of the size that it has there."""
        return resized(self.effect, self.alteration.factor(point)).at(point, conditions)

    def drawn(self, rng: np.random.Generator) -> Effect:
        """With the random phases of one recording."""
        return replace(self, effect=self.effect.drawn(rng))


def resized(effect: Effect, factor: float) -> Effect:
    """An effect of so many times its size, as far as its bounds go; of a level, so many times lower."""
    name = size_of(type(effect))
    q = quantities(type(effect))[name]
    now = getattr(effect, name)
    value = now / factor if q.nothing > LEVEL * q.typical else q.nothing + factor * (now - q.nothing)
    return replace(effect, **{name: float(np.clip(value, q.low, q.high))})


@dataclass(frozen=True)
class StrayOrder(Effect):
    """An order in one gauge that has nothing to do with anything else; in a torque it would be what a ripple is.

    Attributes
    ----------
    channel : int
        Of :data:`swgsim.storage.labelled_signals.SENSORS`.
    order : int
    amplitude : float
        In the channel's unit.
    phase : float
        [rad].
    """

    place = "acquisition"
    channel: int = choice(low=0, high=len(SENSORS) - 1)
    order: int = choice(low=1, high=12)
    amplitude: float = size(unit="-", low=0, high=1, typical=1e-3)
    phase: float = phase()

    def acquisition(
        self, channels: Mapping[str, Float[np.ndarray, " time"]], scene: Scene
    ) -> Mapping[str, Float[np.ndarray, " time"]]:
        """The channels with the wave on one of them."""
        name = SENSORS[self.channel]
        return {**channels, name: channels[name] + self.amplitude * np.cos(self.order * scene.phi_in + self.phase)}
