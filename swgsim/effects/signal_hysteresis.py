"""Imperfection: hysteresis of strain and bond."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import size
from swgsim.effects.turns import samples_per_turn

# Play operators between a radius of nothing and half the range; ten of them draw the loop to within 1 % of its width.
PLAYS = 10


@dataclass(frozen=True)
class SignalHysteresis(Effect):
    """Falling strain shows more than rising strain, however fast it changes (physics.md SE8). Each signal runs through
    its own loop, that of evenly spread plays (Prandtl-Ishlinskii): parabolic branches, and smaller loops inside that
    close. One revolution runs ahead, so that the loop is settled.

    Signature: order 2 of s1 to s4 lags by 0.85 share, the same at all speeds, unlike a filter; order 6 at 0.17 share of
    order 2; mean and amplitude stay. Typical: 2.19 % of full scale, as measured on an integrated sensor with slow load
    cycles; no source says how much is left in the cycle of the wave generator.

    Attributes
    ----------
    share : float
        Greatest difference of the branches over the range of the signal, from 0 to 0.2 (beyond, the clamp slips).
    """

    place = "gauge"
    sharp = True
    share: float = size(unit="-", low=0, high=0.2, typical=0.02)

    def gauge(self, signals: Float[np.ndarray, "5 time"], scene: Scene) -> Float[np.ndarray, "5 time"]:
        """The signals plus 4 share times the distance of the mean play from its middle line, half the signal."""
        low, high = signals.min(axis=1), signals.max(axis=1)
        x = (signals - ((low + high) / 2)[:, None]).T
        radii = ((high - low) / 2)[:, None] * (np.arange(PLAYS) + 0.5) / PLAYS
        floor, ceiling = x[:, :, None] - radii, x[:, :, None] + radii
        held = np.empty_like(floor)
        play = np.zeros_like(radii)
        first_turn = min(round(samples_per_turn(scene)), len(x))
        # While no signal turns back a play rests or is dragged by one end: bounds at once are bounds sample by sample.
        turning = np.flatnonzero(np.diff(np.sign(np.diff(x, axis=0)), axis=0).any(axis=1)) + 2
        starts = np.unique([0, 1, first_turn, *turning, len(x)]).tolist()
        pieces = [slice(*ends) for ends in pairwise(starts)]
        for piece in (*(p for p in pieces if p.stop <= first_turn), *pieces):
            held[piece] = np.clip(play, floor[piece], ceiling[piece])
            play = held[piece.stop - 1]
        return signals + 4 * self.share * (held.mean(axis=2) - x / 2).T
