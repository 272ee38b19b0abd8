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
from swgsim.loop.noise import Floor, floors
from swgsim.loop.tail import log_tail
from swgsim.recording import Recording
from swgsim.recordings import SENSORS

# A line's size may differ from its law over load and speed by this share.
TOLERANCE = 0.3
CONTRADICTION = 1e-4
# Share of a pattern that must lie between the orders, and of its largest direction; less is rounding.
SEEN = 1e-3
# Samples per revolution at which patterns are computed; more than twice the orders that are fitted.
SAMPLES = 48
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
    """The spectrum between the orders of one recording, every gauge in units of its noise.

    Attributes
    ----------
    scene : Scene
    gauges : tuple of str
    scale : array (gauge, line)
        What turns a line of the spectrum into units of the noise.
    orders : array (time, column)
        Orthonormal basis of the orders that were fitted.
    left : array (number,)
        Real and imaginary parts of all lines of what the orders leave.
    """

    scene: Scene
    gauges: tuple[str, ...]
    scale: Float[np.ndarray, "gauge line"]
    orders: Float[np.ndarray, "time column"]
    left: Float[np.ndarray, " number"]

    @classmethod
    def of(cls, recording: Recording, gauges: tuple[str, ...], noise: Sequence[Floor]) -> "Between":
        """Of a recording whose gauges have these floors."""
        step = max(1, int(recording.rate * 60 / recording.point.n_in_rpm / SAMPLES))
        length = len(recording.time) // step * step
        # Patterns are narrow-band: fewer samples hold them as well.
        angle = recording.channels["phi_in"][:length:step]
        load = (
            recording.channels["T_out"][:length:step]
            if "T_out" in recording.channels
            else np.full(len(angle), float(recording.point.T_out))
        )
        time = recording.time[:length:step] - recording.time[0]
        frequency = np.fft.rfftfreq(length, 1 / recording.rate)
        # The mean, and lines beyond the orders that were fitted, say nothing.
        frequency = frequency[1 : np.searchsorted(frequency, FITTED * recording.point.n_in_rpm / 60)]
        scale = np.array([np.sqrt(2 * length / np.maximum(floor.at(frequency), 1e-300)) for floor in noise])
        bare = cls(
            Scene(time, angle, load, recording.point, recording.conditions),
            gauges,
            scale,
            np.linalg.qr(basis(angle, FITTED))[0],
            np.empty(0),
        )
        return replace(bare, left=bare._numbers(remainder(recording, Layout(gauges))[:, :length]))

    def pattern(self, effect: Effect) -> Float[np.ndarray, "column number"]:
        """What an effect can look like, whatever its random phases; a direction that the orders took is left out."""
        random = [name for name, q in quantities(type(effect)).items() if q.role is Role.RANDOM]
        phases = [dict.fromkeys(random, 0.0)]
        phases += [{n: np.pi if n == name else 0.0 for n in random} for name in random[1:]]
        phases += [{n: np.pi / 2 if n == name else 0.0 for n in random} for name in random]
        seen = np.array([self._alone(replace(effect, **each)) for each in phases])
        between = self._numbers(seen - (seen @ self.orders) @ self.orders.T)
        whole = np.linalg.norm(self._numbers(seen), axis=-1).max()
        return between if np.linalg.norm(between, axis=-1).max() > SEEN * whole else np.zeros_like(between)

    def _numbers(self, signals: np.ndarray) -> np.ndarray:
        """Lines of the spectrum in units of the noise, real parts before imaginary ones."""
        lines = np.fft.rfft(signals, axis=-1)[..., 1 : self.scale.shape[1] + 1] / signals.shape[-1] * self.scale
        flat = lines.reshape(*lines.shape[:-2], -1)
        return np.concatenate([flat.real, flat.imag], axis=-1)

    def _alone(self, effect: Effect) -> Float[np.ndarray, "gauge time"]:
        """What an effect puts on silent gauges."""
        silent = effect.gauge(np.zeros((len(SENSORS), len(self.scene.time))), self.scene)
        channels = effect.acquisition(dict(zip(SENSORS, silent, strict=True)), self.scene)
        return np.array([channels[gauge] for gauge in self.gauges])


def between(recordings: Sequence[Recording]) -> list[Between]:
    """What lies between the orders of every recording; nothing if they have no gauge in common."""
    gauges = tuple(sensor for sensor in SENSORS if all(sensor in r.channels for r in recordings))
    noise = floors(recordings, Layout(gauges)) if gauges else []
    return [Between.of(recording, gauges, noise) for recording in recordings] if gauges else []


def sidelines(recordings: Sequence[Recording], kinds: Iterable[type[Effect]]) -> list[Sideline]:
    """The best hypothesis of every effect that has a random phase and acts on the signals, the likeliest first."""
    spectra = between(recordings)
    kinds = [kind for kind in kinds if has_sidelines(kind)] if spectra else []
    found = []
    for kind in kinds:
        declared = quantities(kind)
        size = next(name for name, q in declared.items() if q.role is Role.SIZE)
        inner = {name: q.tried for name, q in declared.items() if q.role in (Role.SHAPE, Role.CHOICE)}
        tries = [
            kind(**dict(zip(inner, values, strict=True)), **{size: declared[size].typical})
            for values in product(*inner.values())
        ]
        # The zoom tries some more.
        chances = 2 * len(tries) * len(kinds)
        best = max((_judged(effect, spectra, chances) for effect in tries), key=lambda line: line.rank)
        found.append(_zoomed(best, spectra, chances))
    return sorted(found, key=lambda line: -line.rank)


def has_sidelines(kind: type[Effect]) -> bool:
    """Whether an effect has a random phase, and acts on the recorded signals rather than within the chain."""
    random = any(q.role is Role.RANDOM for q in quantities(kind).values())
    return random and any(getattr(kind, place) is not getattr(Effect, place) for place in ("gauge", "acquisition"))


def _judged(effect: Effect, between: Sequence[Between], tried: int) -> Sideline:
    """One hypothesis at all recordings."""
    declared = quantities(type(effect))
    name = next(n for n, q in declared.items() if q.role is Role.SIZE)
    gains, freedoms, sizes = [], [], []
    for each in between:
        pattern = each.pattern(effect)
        U, s, _ = np.linalg.svd(pattern.T, full_matrices=False)
        U = U[:, s > SEEN * s[0]] if s[0] > 0 else U[:, :0]
        gains.append(float(((U.T @ each.left) ** 2).sum()))
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
