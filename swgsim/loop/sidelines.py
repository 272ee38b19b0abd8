"""Lines between the integer orders: a bearing's cage and balls, the mains, sub-harmonics. Their phase is another one in
every recording, so the model cannot predict them; their power and their pattern over the gauges can be tested.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2

from swgsim.effects.base import Effect, Scene
from swgsim.effects.quantity import Role, quantities
from swgsim.loop.features import FITTED, Layout, basis, remainder
from swgsim.loop.noise import density
from swgsim.loop.tail import log_tail
from swgsim.recording import Recording
from swgsim.recordings import SENSORS

# A line's size may differ from its law over load and speed by this share.
TOLERANCE = 0.3
CONTRADICTION = 1e-4
ZOOMS = 3


@dataclass(frozen=True)
class Sideline:
    """An effect with random phases, beside what the recordings hold of it.

    Attributes
    ----------
    effect : Effect
        At its estimated size; its phases mean nothing.
    gain : float
        Sum of squares that it explains, in units of the noise.
    freedom : int
        Numbers that this fits: a cosine and a sine per recording and independent phase.
    chance : float
        Probability of as much by noise anywhere in the library.
    deviation : float
        Standard deviation of the size.
    agrees : float
        Probability that recordings differ so much from the effect's law, if that is right to TOLERANCE.
    """

    effect: Effect
    gain: float
    freedom: int
    chance: float
    deviation: float
    agrees: float

    @property
    def rank(self) -> float:
        """How unlikely the gain is by luck."""
        return -2 * float(log_tail(self.gain, self.freedom))


@dataclass(frozen=True, eq=False)
class Between:
    """What lies between the orders of one recording, every gauge in units of its noise."""

    scene: Scene
    gauges: tuple[str, ...]
    noise: Float[np.ndarray, " gauge"]
    left: Float[np.ndarray, "gauge time"]
    orders: Float[np.ndarray, "time column"]

    @classmethod
    def of(cls, recording: Recording) -> "Between":
        """Of a recording."""
        gauges = tuple(sensor for sensor in SENSORS if sensor in recording.channels)
        layout = Layout(gauges)
        noise = np.sqrt(density(recording, layout))
        angle = recording.channels["phi_in"]
        load = recording.channels.get("T_out", np.full(len(angle), recording.point.T_out))
        scene = Scene(recording.time - recording.time[0], angle, load, recording.point, recording.conditions)
        columns = np.linalg.qr(basis(angle, FITTED))[0]
        return cls(scene, gauges, noise, remainder(recording, layout) / noise[:, None], columns)

    def pattern(self, effect: Effect) -> Float[np.ndarray, "column gauge time"]:
        """What an effect can look like, whatever its random phases, between the orders and in units of the noise."""
        random = [name for name, q in quantities(type(effect)).items() if q.role is Role.RANDOM]
        phases = [dict.fromkeys(random, 0.0)]
        phases += [{n: np.pi if n == name else 0.0 for n in random} for name in random[1:]]
        phases += [{n: np.pi / 2 if n == name else 0.0 for n in random} for name in random]
        seen = np.array([self._alone(replace(effect, **each)) for each in phases])
        return (seen - (seen @ self.orders) @ self.orders.T) / self.noise[:, None]

    def _alone(self, effect: Effect) -> Float[np.ndarray, "gauge time"]:
        """What an effect puts on silent gauges."""
        silent = effect.gauge(np.zeros((len(SENSORS), len(self.scene.time))), self.scene)
        channels = effect.acquisition(dict(zip(SENSORS, silent, strict=True)), self.scene)
        return np.array([channels[gauge] for gauge in self.gauges])


def sidelines(recordings: Sequence[Recording], kinds: Iterable[type[Effect]]) -> list[Sideline]:
    """The best hypothesis of every effect that has a random phase and acts on the signals, the likeliest first."""
    between = [Between.of(recording) for recording in recordings]
    found = []
    for kind in kinds:
        declared = quantities(kind)
        if not any(q.role is Role.RANDOM for q in declared.values()) or not overrides_signals(kind):
            continue
        size = next(name for name, q in declared.items() if q.role is Role.SIZE)
        inner = {name: q.tried for name, q in declared.items() if q.role in (Role.SHAPE, Role.CHOICE)}
        tries = [
            kind(**dict(zip(inner, values, strict=True)), **{size: declared[size].typical})
            for values in product(*inner.values())
        ]
        best = max((_judged(effect, between, len(tries)) for effect in tries), key=lambda line: line.rank)
        found.append(_zoomed(best, between, len(tries)))
    return sorted(found, key=lambda line: -line.rank)


def overrides_signals(kind: type[Effect]) -> bool:
    """Whether an effect acts on the recorded signals rather than within the chain."""
    return any(getattr(kind, place) is not getattr(Effect, place) for place in ("gauge", "acquisition"))


def _judged(effect: Effect, between: Sequence[Between], tried: int) -> Sideline:
    """One hypothesis at all recordings."""
    declared = quantities(type(effect))
    name = next(n for n, q in declared.items() if q.role is Role.SIZE)
    gains, freedoms, sizes = [], [], []
    for each in between:
        pattern = each.pattern(effect).reshape(-1, each.left.size)
        U, s, _ = np.linalg.svd(pattern.T, full_matrices=False)
        U = U[:, s > 1e-6 * s[0]] if s[0] > 0 else U[:, :0]
        gains.append(float(((U.T @ each.left.ravel()) ** 2).sum()))
        freedoms.append(U.shape[1])
        sizes.append(float((pattern[0] ** 2).sum()))
    gain, freedom, size = np.array(gains), np.array(freedoms), np.array(sizes)
    # Power of the effect beyond the noise, in units of its typical size squared.
    share = float(max(gain.sum() - freedom.sum(), 0.0) / max(size.sum(), 1e-300))
    expected = freedom + share * size
    spread = 2 * freedom + 4 * share * size + (2 * TOLERANCE * share * size) ** 2
    used = freedom > 0
    agrees = float(chi2.sf((((gain - expected) ** 2) / np.maximum(spread, 1e-12))[used].sum(), max(used.sum() - 1, 1)))
    chance = float(min(1.0, tried * chi2.sf(gain.sum(), max(freedom.sum(), 1))))
    estimate = float(np.clip(getattr(effect, name) * np.sqrt(share), declared[name].low, declared[name].high))
    deviation = abs(getattr(effect, name)) / float(np.sqrt(max(size.sum(), 1e-300)))
    return Sideline(
        replace(effect, **{name: estimate}), float(gain.sum()), int(freedom.sum()), chance, deviation, agrees
    )


def _zoomed(best: Sideline, between: Sequence[Between], tried: int) -> Sideline:
    """The line with its order or frequency no longer on the grid."""
    declared = quantities(type(best.effect))
    size = next(name for name, q in declared.items() if q.role is Role.SIZE)
    searched = [name for name, q in declared.items() if q.role is Role.SHAPE and q.points > 1]
    for name in searched:
        q = declared[name]
        reach = (q.high - q.low) / q.points
        for _ in range(ZOOMS):
            values = np.clip(getattr(best.effect, name) + reach * np.linspace(-1, 1, 5), q.low, q.high)
            around = [replace(best.effect, **{name: float(v), size: declared[size].typical}) for v in values]
            best = max((_judged(effect, between, tried) for effect in around), key=lambda line: line.rank)
            reach /= 2
    return best
