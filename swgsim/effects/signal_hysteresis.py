from dataclasses import dataclass

import numpy as np

from swgsim.effects.base import Effect, Scene, Signals
from swgsim.effects.quantity import size
from swgsim.effects.turns import samples_per_turn

# Play operators between a radius of nothing and half the range; ten of them draw the loop to within 1 % of its width.
PLAYS = 10


@dataclass(frozen=True)
class SignalHysteresis(Effect):
    """Strain and bond have a hysteresis: falling strain shows more than rising strain, at any speed (physics.md SE8).

    Each signal runs through its own loop of evenly spread plays (Prandtl-Ishlinskii). The branches are parabolic, and
    smaller loops inside close. One revolution runs ahead, so that the loop is settled.

    Signature: order 2 of s1 to s4 lags by 0.85 share at all speeds, unlike with a filter. Order 6 is 0.17 share of
    order 2; mean and amplitude stay. Typical: 2.19 % of full scale, measured on an integrated sensor with slow load
    cycles. No source gives the value for the fast cycles of the wave generator.

    Attributes
    ----------
    share : float
        Greatest difference of the branches over the range of the signal, from 0 to 0.2 (beyond, the clamp slips).
    """

    place = "gauge"
    sharp = True
    share: float = size(unit="-", low=0, high=0.2, typical=0.02)

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The signals plus 4 share times the distance of the mean play from its middle line, half the signal."""
        low, high = signals.min(axis=1), signals.max(axis=1)
        x = signals - ((low + high) / 2)[:, None]
        radii = ((high - low) / 2)[:, None] * (np.arange(PLAYS) + 0.5) / PLAYS
        floor, ceiling = x[:, None] - radii[..., None], x[:, None] + radii[..., None]
        first_turn = min(round(samples_per_turn(scene)), x.shape[1])
        # While no signal turns back a play rests or is dragged by one end: bounds at once are bounds sample by sample.
        turning = np.flatnonzero(np.diff(np.sign(np.diff(x)), axis=1).any(axis=0)) + 2
        bounds = np.unique([0, 1, first_turn, *turning, x.shape[1]])
        ends = bounds[1:]
        lowest, highest = (np.moveaxis(bound[..., ends - 1], -1, 0) for bound in (floor, ceiling))
        plays = [np.zeros_like(radii)]
        for end in (*np.flatnonzero(ends <= first_turn), *range(len(ends))):
            plays.append(np.minimum(np.maximum(plays[-1], lowest[end]), highest[end]))
        before = np.repeat(np.stack(plays[-len(ends) - 1 : -1], axis=-1), np.diff(bounds), axis=-1)
        held = np.minimum(np.maximum(before, floor), ceiling)
        return signals + 4 * self.share * (held.mean(axis=1) - x / 2)
