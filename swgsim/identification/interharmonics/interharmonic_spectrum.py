"""The spectrum of recordings between the integer orders, in units of the noise."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Complex, Float
from scipy.ndimage import maximum_filter1d
from scipy.stats import f

from swgsim.effects.base import Effect, Scene
from swgsim.identification.data.features import FITTED, Layout
from swgsim.identification.data.noise import GUARD, Floor, floors, step_of
from swgsim.identification.interharmonics.seen_lines import LEAST_SHARE, SeenLines, orthonormal
from swgsim.identification.interharmonics.signal_shapes import ordinary, scene_of, shapes
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Samples per revolution at which patterns are computed; more than twice the orders that are fitted.
SAMPLES_PER_TURN = 48
# Number of spectral lines on either side from which the noise next to a line is estimated.
NOISE_LINES = 6
# Weight of the common noise floor in the noise next to a line, as a number of degrees of freedom.
ALL_TOGETHER = 20
# Effects whose patterns are computed at once: as many as a cache of the processor holds.
AT_ONCE = 16
# Part of a direction that a line must hold to be one of its lines.
LEAST_PROJECTION = 0.05

# Of one line, or of many.
Sums = float | Float[np.ndarray, "*line"]


class Explained(NamedTuple):
    """What each of some effects explains of one recording.

    Attributes
    ----------
    gain : array (effect,)
        Sum of squares that the effect explains, in units of the noise.
    freedom : array (effect,)
        Its degrees of freedom: noise alone gives a gain of this much on average.
    own_gain : array (effect,)
        Gain that the effect would have without noise if its size were the one that it is given with.
    rest : array (effect,)
        Sum of squares of the noise next to its lines.
    noise_numbers : array (effect,)
        Degrees of freedom of ``rest``.
    """

    gain: Float[np.ndarray, " effect"]
    freedom: Float[np.ndarray, " effect"]
    own_gain: Float[np.ndarray, " effect"]
    rest: Float[np.ndarray, " effect"]
    noise_numbers: Float[np.ndarray, " effect"]


@dataclass(frozen=True, eq=False)
class GaugeSpectrum:
    """The spectrum of one recording between the integer orders, every gauge in units of its noise.

    Attributes
    ----------
    scene : Scene
    gauges : tuple of str
    scale : array (gauge, line)
        What turns a line of the spectrum into units of the noise.
    orders : array (time, column)
        Orthonormal basis of the orders that were fitted, with a drift and beats.
    revolutions : float
        Of the wave generator, as measured: line k lies at the order k / revolutions.
    clear : array (line,)
        Lines that no integer order leaks into.
    left : array (number,)
        Real and imaginary parts of all spectral lines after the orders were removed, gauge by gauge; 0 where the orders
        leak.
    taken : array (number, direction)
        Orthonormal directions over several gauges that were projected out: lines that were found.
    alone : array (gauge, one, own)
        The same within each gauge: ends of slow noise, and lines that may be in every gauge by themselves. Each gauge
        has as many, some being 0.
    """

    scene: Scene
    gauges: tuple[str, ...]
    scale: Float[np.ndarray, "gauge line"]
    orders: Float[np.ndarray, "time column"]
    revolutions: float
    clear: Bool[np.ndarray, " line"]
    left: Float[np.ndarray, " number"]
    taken: Float[np.ndarray, "number direction"]
    alone: Float[np.ndarray, "gauge one own"]

    @classmethod
    def of(
        cls, recording: Recording, gauges: tuple[str, ...], noise: Sequence[Floor], N: int | None
    ) -> "GaugeSpectrum":
        """Of a recording whose gauges have these floors, of a gear of this ratio."""
        step = max(1, int(recording.rate * 60 / recording.point.n_in_rpm / SAMPLES_PER_TURN))
        length = len(recording.time) // step * step
        # Patterns are narrow-band: fewer samples hold them as well.
        scene = scene_of(recording, slice(0, length, step))
        angle = scene.phi_in
        revolutions = abs(float(angle[-1] - angle[0])) / (2 * np.pi) * len(angle) / (len(angle) - 1)
        # The mean, and lines beyond the orders that were fitted, say nothing.
        lines = np.arange(1, int(np.ceil(FITTED * revolutions)))
        frequency = lines * recording.rate / length
        rounding = [_rounding(recording.channels[gauge], floor) for gauge, floor in zip(gauges, noise, strict=True)]
        variance = [floor.at(frequency) / (2 * length) + own for floor, own in zip(noise, rounding, strict=True)]
        order = lines / revolutions
        clear = np.abs(order - np.round(order)) * revolutions > GUARD
        scale = 1 / np.sqrt(np.maximum(variance, 1e-300))
        bare = cls(
            scene,
            gauges,
            scale,
            np.linalg.qr(ordinary(scene, N))[0],
            revolutions,
            clear,
            left=np.zeros(2 * scale.size),
            taken=np.empty((2 * scale.size, 0)),
            alone=np.empty((len(gauges), 2 * len(lines), 0)),
        )
        whole = scene_of(recording)
        signals = [np.array([recording.channels[gauge] for gauge in gauges]), *_ends(whole, noise)]
        remainder = _without(np.array(signals), np.linalg.qr(ordinary(whole, N))[0])
        spectra = _spectrum(remainder[..., :length])[..., : len(lines)] * scale
        left, *ends = bare._numbers(spectra)
        # Each is of another gauge, in units of its own noise.
        alone = np.array([end[i] / np.linalg.norm(end[i]) for i, end in enumerate(ends)])[..., None]
        return replace(bare, left=left.ravel())._taking_alone(alone)

    @property
    def step(self) -> float:
        """Distance of two lines of the spectrum [Hz]."""
        return 1 / (len(self.scene.time) * (self.scene.time[1] - self.scene.time[0]))

    @property
    def power(self) -> Float[np.ndarray, "gauge line"]:
        """Sum of squares of every line; of noise, 2 on average where it is clear."""
        return (self.left**2).reshape(len(self.gauges), 2, -1).sum(axis=1)

    def pattern(self, effect: Effect) -> Float[np.ndarray, "column number"]:
        """What an effect can look like, whatever its random phases; a direction that the orders took is left out."""
        return self._patterns([effect])

    def _patterns(self, effects: Sequence[Effect], apart: Sequence[str] = ()) -> Float[np.ndarray, "column number"]:
        """The same of several effects, one after the other."""
        seen = self._seen(effects, apart)
        return seen.shown(_without(seen.dense(len(self.gauges)), self.taken))

    def _seen(self, effects: Sequence[Effect], apart: Sequence[str] = ()) -> SeenLines:
        """What effects can put between the orders, without what was taken out of single gauges."""
        made = [shapes(effect, self.scene, self.gauges) for effect in effects]
        effect, signals = np.repeat(np.arange(len(made)), [len(each) for each in made]), np.concatenate(made)
        column, gauge = np.nonzero(signals.any(axis=-1))
        loud, scale = signals[column, gauge], self.scale[gauge]
        lines = _spectrum(loud)[:, : scale.shape[1]] * scale
        numbers = self._numbers(lines - (loud @ self.orders) @ self._of_orders * scale)
        for number, taken in enumerate(self.alone):
            numbers[gauge == number] = _without(numbers[gauge == number], taken)
        seen = SeenLines(effect, column, gauge, numbers, np.linalg.norm(lines, axis=-1))
        return seen.apart([self.gauges.index(name) for name in apart]) if apart else seen

    def _by_gauge(self, numbers: Float[np.ndarray, "number column"]) -> Float[np.ndarray, "gauge one column"]:
        return numbers.reshape(len(self.gauges), len(numbers) // len(self.gauges), numbers.shape[1])

    @cached_property
    def _spare(self) -> Float[np.ndarray, " number"]:
        """Degrees of freedom that what was taken leaves of every number."""
        return 1.0 - (self.taken**2).sum(axis=1) - (self.alone**2).sum(axis=-1).ravel()

    def explained(self, effects: Sequence[Effect]) -> Explained:
        """What each of some effects of one kind explains of this recording."""
        some = (effects[i : i + AT_ONCE] for i in range(0, len(effects), AT_ONCE))
        patterns = (self._patterns(each).reshape(len(each), -1, len(self.left)) for each in some)
        found = [self._explained_by(each, self.left, self._spare) for each in patterns]
        return Explained(*np.concatenate(found, axis=1))

    def explained_beside(self, effects: Sequence[Effect]) -> Explained:
        """What each effect explains if the other effects are present too; without them, they would count as noise."""
        seen = self._seen(effects)
        patterns = seen.shown(_without(seen.dense(len(self.gauges)), self.taken))
        patterns = patterns.reshape(len(effects), -1, len(self.left))
        others = (np.delete(patterns, i, axis=0).reshape(-1, len(self.left)) for i in range(len(effects)))
        taken = [each.T @ orthonormal(each @ each.T) for each in others]
        alone = np.concatenate([_without(each, U) for each, U in zip(patterns, taken, strict=True)])
        alone = seen.shown(alone).reshape(patterns.shape)
        found = [
            self._explained_by(each[None], _without(self.left, U), self._spare - (U**2).sum(axis=1))
            for each, U in zip(alone, taken, strict=True)
        ]
        return Explained(*np.concatenate(found, axis=1))

    def _explained_by(
        self, patterns: Float[np.ndarray, "effect column number"], left: Float[np.ndarray, " number"],
        spare: Float[np.ndarray, " number"],
    ) -> Explained:  # fmt: skip
        """What patterns explain of numbers that are left, of which each has so many degrees of freedom."""
        # Orthonormal directions, from the few products of the columns: the columns are long. Products so small are
        # slower where threads share them.
        power, axes = np.linalg.eigh(np.einsum("ecn,edn->ecd", patterns, patterns))
        used = power > LEAST_SHARE**2 * np.maximum(power[:, -1:], 1e-300)
        turned = axes * (used / np.sqrt(np.where(used, power, 1.0)))[:, None]
        U = np.einsum("edc,edn->ecn", turned, patterns)
        along = np.einsum("ecn,n->ec", U, left)
        square = (U**2).sum(axis=1)
        holds = square.reshape(len(patterns), -1, self.scale.shape[1]).sum(axis=1) > LEAST_PROJECTION
        near = maximum_filter1d(holds.astype(np.uint8), 2 * NOISE_LINES + 1, mode="constant") > 0
        neighbours = np.tile(near & self.clear, 2 * len(self.gauges))
        rest = ((left - np.einsum("ec,ecn->en", along, U)) ** 2 * neighbours).sum(axis=1)
        count = (neighbours * (spare - square)).sum(axis=1)
        own_gain = (patterns[:, 0] ** 2).sum(axis=1)
        return Explained((along**2).sum(axis=1), used.sum(axis=1), own_gain, rest, count)

    def held(self, effects: Sequence[Effect], apart: Sequence[str] = ()) -> float:
        """Sum of squares of what these effects may have put there, in each of some gauges apart if any are given."""
        seen = self._seen(effects, apart)
        along, by_taken = (seen.along(self._by_gauge(each)) for each in (self.left[:, None], self.taken))
        products = seen.products() - by_taken @ by_taken.T
        shown = seen.shows(np.diag(products))
        axes = orthonormal(products * np.outer(shown, shown))
        return float(((axes.T @ (along[:, 0] * shown)) ** 2).sum())

    def without(self, effects: Sequence[Effect], apart: Sequence[str] = ()) -> "GaugeSpectrum":
        """The spectrum without anything that these effects may have put there; ``apart`` as of :meth:`held`."""
        patterns = self._patterns(effects, apart)
        if not apart or self.taken.shape[1]:
            U = patterns.T @ orthonormal(patterns @ patterns.T)
            return replace(self, left=_without(self.left, U), taken=np.hstack([self.taken, U]))
        columns = self._by_gauge(patterns.T)
        return self._taking_alone(columns @ orthonormal(columns.swapaxes(1, 2) @ columns))

    def _taking_alone(self, U: Float[np.ndarray, "gauge one direction"]) -> "GaugeSpectrum":
        left = self._by_gauge(self.left[:, None])
        left = left - U @ (U.swapaxes(1, 2) @ left)
        return replace(self, left=left.ravel(), alone=np.concatenate([self.alone, U], axis=-1))

    @cached_property
    def _of_orders(self) -> Complex[np.ndarray, "column line"]:
        """Spectrum of the basis of the orders: to take them out of a spectrum costs less than another transform."""
        return _spectrum(self.orders.T)[:, : self.scale.shape[1]]

    def _numbers(self, lines: Complex[np.ndarray, "*any line"]) -> Float[np.ndarray, "*any number"]:
        """Clear lines of the spectrum of a gauge in units of the noise, real parts before imaginary ones."""
        clear = lines * self.clear
        return np.concatenate([clear.real, clear.imag], axis=-1)


def gauge_spectra(recordings: Sequence[Recording], N: int | None = None) -> list[GaugeSpectrum]:
    """What lies between the orders of every recording; nothing if they have no gauge in common.

    Parameters
    ----------
    recordings : sequence of Recording
    N : int, optional
        Ratio of their gear, whose circular spline beats with its flex spline.
    """
    gauges = tuple(sensor for sensor in SENSORS if recordings and all(sensor in r.channels for r in recordings))
    noise = floors(recordings, Layout(gauges)) if gauges else []
    return [GaugeSpectrum.of(recording, gauges, noise, N) for recording in recordings] if gauges else []


def f_test(gain: Sums, freedom: Sums, rest: Sums, count: Sums) -> tuple[Sums, Sums]:
    """The noise at a line, in units of the floor, and the probability that it explains as much as the line does.

    The floor holds for the whole spectrum; beside a line the noise may be higher, and is never taken for lower. Given
    are sums over recordings of what :class:`Explained` holds.
    """
    noise = np.maximum(1.0, (rest + ALL_TOGETHER) / (count + ALL_TOGETHER))
    return noise, f.sf(gain / noise / freedom, freedom, count + ALL_TOGETHER)


def _ends(scene: Scene, noise: Sequence[Floor]) -> Float[np.ndarray, "gauge gauge time"]:
    """Leakage of slow noise by the ends of a recording, gauge by gauge.

    A spectrum goes on at the end where it began, so the step from the one to the other rings in all its lines, alike,
    and would pass for a line between them. It dies away as the noise forgets; without it the lines are independent.
    """
    fading = [np.exp(-2 * np.pi * floor.corner * scene.time) for floor in noise]
    return np.eye(len(noise))[:, :, None] * np.array(fading)[:, None]


def _spectrum(signals: Float[np.ndarray, "*any time"]) -> Complex[np.ndarray, "*any line"]:
    """Lines from the first one on."""
    return np.fft.rfft(signals, axis=-1)[..., 1:] / signals.shape[-1]


def _without(signals: Float[np.ndarray, "*any time"], Q: Float[np.ndarray, "time column"]) -> np.ndarray:
    """Signals without their part along orthonormal columns."""
    return signals - (signals @ Q) @ Q.T


def _rounding(values: Float[np.ndarray, " time"], noise: Floor) -> float:
    """Variance of the lines that rounding by a converter makes, of half a step at most; noise makes it noise too."""
    step = step_of(values)
    return step**2 / 32 if np.sqrt(noise.white) < step / 2 else 0.0
