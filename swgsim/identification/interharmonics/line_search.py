"""Search for interharmonic lines, the strongest first, and recordings from which they are subtracted.

A strong line leaks into the orders and would pass for another effect there. A line that the healthy gear shows as well
is subtracted too, but not reported.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.common.singular import svd
from swgsim.effects.base import Effect
from swgsim.identification.interharmonics.interharmonic_spectrum import GaugeSpectrum
from swgsim.identification.interharmonics.line_growth import chance_of_growth
from swgsim.identification.interharmonics.line_pattern import outdoes
from swgsim.identification.interharmonics.named_interharmonics import Sideline, nearby, ranked
from swgsim.identification.interharmonics.signal_shapes import ordinary, scene_of, shapes
from swgsim.identification.interharmonics.unattributed_lines import Unnamed, unnamed
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Lines that are reported at most, with a name or without.
MOST_LINES = 4
# Shapes below this share of the largest one are rounding; above the other one they are seen as well as it.
LEAST_SHAPE, WELL_SEEN = 1e-3, 0.5


@dataclass(frozen=True, eq=False)
class LinesBetween:
    """Interharmonic lines that were found.

    Attributes
    ----------
    named : tuple of Sideline
    unnamed : tuple of Unnamed
    left : tuple of GaugeSpectrum
        The spectra without it.
    effects : tuple of Effect
        All that it may have put on the signals.
    healthy : tuple of GaugeSpectrum
        Those of the healthy gear without it.
    usual : tuple of Sideline or Unnamed
        Lines that the healthy gear shows as well; of its own they have parts.
    """

    named: tuple[Sideline, ...]
    unnamed: tuple[Unnamed, ...]
    left: tuple[GaugeSpectrum, ...]
    effects: tuple[Effect, ...]
    healthy: tuple[GaugeSpectrum, ...] = ()
    usual: tuple[Sideline | Unnamed, ...] = ()

    @property
    def usual_effects(self) -> tuple[Effect, ...]:
        """The lines that the healthy gear shows as well, as effects that can be declared."""
        return tuple(
            effect
            for line in self.usual
            for effect in ((line.effect,) if isinstance(line, Sideline) else (part.effect for part in line.parts))
        )

    def taking_out(self, effects: Sequence[Effect], apart: Sequence[str] = ()) -> "LinesBetween":
        """The same without what these effects may have put there, in each of some gauges apart if any are given."""
        left, healthy = (
            tuple(each.without(effects, apart) for each in spectra) for spectra in (self.left, self.healthy)
        )
        return replace(self, left=left, healthy=healthy, effects=(*self.effects, *effects))

    def with_named(self, line: Sideline, level: float) -> "LinesBetween":
        """The same with one more effect, which is news or not."""
        # It may have grown as a whole, or in one gauge.
        if self._is_news((line.effect,), level / 2) or self._is_news(line.effect.parts(), level / 2):
            return replace(self, named=(*self.named, line))
        return replace(self, usual=(*self.usual, line))

    def without_line(self, line: Unnamed) -> "LinesBetween":
        """The same without anything that a line without a name may have put there."""
        return self.taking_out(line.effects, apart=self.left[0].gauges)

    def is_news(self, line: Unnamed, level: float) -> bool:
        """Whether the healthy gear does not show a line as well, in no gauge as much."""
        return self._is_news(line.alone(self.left[0].gauges), level)

    def _is_news(self, parts: Sequence[Effect], level: float) -> bool:
        """Whether a line of the healthy gear would show so much with a probability below this level only."""
        return not self.healthy or chance_of_growth(parts, self.left, self.healthy) <= level


def search(
    spectra: Sequence[GaugeSpectrum],
    kinds: Iterable[type[Effect]],
    level: float,
    known: Sequence[Effect] = (),
    healthy: Sequence[GaugeSpectrum] = (),
) -> LinesBetween:
    """Find interharmonic lines one after the other, as long as one is significant.

    Parameters
    ----------
    spectra : sequence of GaugeSpectrum
        Of all recordings.
    kinds : iterable of effect classes
    level : float
        Probability of a false one.
    known : sequence of Effect
        Declared effects, which are taken out first.
    healthy : sequence of GaugeSpectrum
        Of the recordings of the healthy gear, if there are any.
    """
    found = _without_known(LinesBetween((), (), tuple(spectra), (), tuple(healthy)), known)
    sought = list(kinds)
    while len(found.named) + len(found.unnamed) < MOST_LINES:
        bare = unnamed(found.left, level)
        if bare and not found.is_news(bare, level):  # it needs no name, and to look for one takes long
            found = replace(found, usual=(*found.usual, bare)).without_line(bare)
            continue
        likely = ranked(found.left, sought)
        best = next((line for line in likely[:1] if line.chance <= level and line.holds), None)
        if bare and (best is None or outdoes(bare.explained, best.explained)):
            coupled = (line for line in likely if line.chance <= level and line.holds and _in_parts(line))
            best = next((line for line in coupled if _explains(line, bare, found.left)), None)
        if best:
            found = found.with_named(best, level).taking_out(_near(best, spectra))
            sought = [kind for kind in sought if _in_parts(best) or kind is not type(best.effect)]
        elif bare:
            bare = bare.with_parts(found.left, level)
            found = replace(found, unnamed=(*found.unnamed, bare)).without_line(bare)
        else:
            break
    return found


def lines_of_healthy(spectra: Sequence[GaugeSpectrum], level: float, known: Sequence[Effect] = ()) -> LinesBetween:
    """All significant interharmonic lines of the healthy gear: none is news, and their causes do not matter.

    They leak into its orders. Parameters as of :func:`search`.
    """
    found = _without_known(LinesBetween((), (), tuple(spectra), ()), known)
    while line := unnamed(found.left, level):
        found = replace(found, usual=(*found.usual, line.with_parts(found.left, level))).without_line(line)
    return found


def _without_known(found: LinesBetween, known: Sequence[Effect]) -> LinesBetween:
    """The same without declared effects."""
    for effect in known if found.left else ():
        found = found.taking_out(nearby(effect, found.left))
    return found


def _in_parts(line: Sideline) -> bool:
    """Whether only its frequency identifies the cause, not its pattern over the gauges."""
    return len(line.effect.parts()) > 1


def _explains(line: Sideline, bare: Unnamed, left: Sequence[GaugeSpectrum]) -> bool:
    """Whether the parts of an effect, each of any size, explain what a line without a name does."""
    explained = sum(each.held(_near(line, left)) for each in left) - bare.noise
    return not outdoes(bare.explained, explained)


def _near(line: Sideline, spectra: Sequence[GaugeSpectrum]) -> list[Effect]:
    """All that may be there where an effect is."""
    return [part for each in nearby(line.effect, spectra) for part in each.parts()]


def all_cleaned(
    recordings: Sequence[Recording], effects: Sequence[Effect], N: int | None = None
) -> tuple[Recording, ...]:
    """The recordings, each :func:`cleaned`."""
    return tuple(cleaned(each, effects, N) for each in recordings) if effects else tuple(recordings)


def cleaned(recording: Recording, effects: Sequence[Effect], N: int | None = None) -> Recording:
    """A recording without what effects between the orders may have put on its gauges.

    Parameters
    ----------
    recording : Recording
    effects : sequence of Effect
        Their sizes and random phases mean nothing.
    N : int, optional
        Ratio of the gear, as it was given to
        :func:`~swgsim.identification.interharmonics.interharmonic_spectrum.gauge_spectra`.
    """
    scene, channels = scene_of(recording), recording.channels
    gauges = tuple(sensor for sensor in SENSORS if sensor in channels)
    seen = np.concatenate([shapes(effect, scene, gauges) for effect in effects])
    orders = ordinary(scene, N)
    clean = {name: channels[name] - _part(channels[name], seen[:, i].T, orders) for i, name in enumerate(gauges)}
    return replace(recording, channels={**channels, **clean})


def _part(
    signal: Float[np.ndarray, " time"], seen: Float[np.ndarray, "time shape"], orders: Float[np.ndarray, "time column"]
) -> Float[np.ndarray, " time"]:
    """The part of a signal that interharmonic shapes explain.

    Shapes that the orders nearly hold, such as those of order 12.01, or that nearly hold one another, are told apart by
    noise alone: least squares would give them any size. None is taken to be larger than those that are seen well are.
    """
    Q = np.linalg.qr(orders)[0]
    left, seen_left = (each - Q @ (Q.T @ each) for each in (signal, seen))
    U, s, V = svd(seen_left)
    shown = s > LEAST_SHAPE * max(float(s[0]), 1e-300)
    U, s, V = U[:, shown], s[shown], V[shown]
    along = U.T @ left
    noise = (left @ left - along @ along) / (len(left) - orders.shape[1] - len(s))
    well = s > WELL_SEEN * s[:1]
    power = np.mean((along[well] / s[well]) ** 2) if len(s) else 1.0
    return seen @ (V.T @ (along * s / (s**2 + noise / max(power, 1e-300))))
