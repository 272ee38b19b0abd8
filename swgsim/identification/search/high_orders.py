"""Regularities at orders above those that the model is compared at.

Lobes and flex spline make next to nothing there, so nothing is fitted: what the model has, and what the gear had by
laws of load and speed when it was healthy, is known to a share, and what goes beyond that is missing.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Complex, Float

from swgsim.chain.chain import distinct, simulate_turns
from swgsim.common.singular import svd
from swgsim.effects.regularity import HIGHEST_ORDER, LAWS, PATTERNS
from swgsim.identification.covariance.narrow_band import frequencies, narrow_bands
from swgsim.identification.data.features import ORDERS, Layout, basis, layout_of, samples_per_turn
from swgsim.identification.data.model import Model, Situation
from swgsim.identification.data.noise import RESOLVED, floors
from swgsim.identification.data.repeated import about_mean, freedom, groups_of
from swgsim.identification.data.unit_lines import laws
from swgsim.identification.fit.form_error import FORM_TOLERANCE
from swgsim.identification.interharmonics.interharmonic_spectrum import f_test
from swgsim.identification.search.regularities import Atom, Described, other_laws
from swgsim.recordings.recording import Recording

# Share of a line that is known to which it may differ all the same, as by an index that is off by 1 degree at order 30.
LINE_TOLERANCE = 0.5
# Samples per revolution of the model.
SAMPLES_PER_TURN = 128
# Laws below this share of the largest one are rounding, as where few operating points were recorded.
RANK = 1e-6


@dataclass(frozen=True, eq=False)
class Above:
    """Remainder of the lines after model and healthy gear, in units of their noise.

    Attributes
    ----------
    channels : tuple of str
    lines : array (order, channel, recording)
        What the model, and laws of load and speed of the healthy gear, leave of them, from the order ORDERS + 1 on.
    laws : array (order, channel, recording, law)
        What these leave of a line of size 1 by each law of the vocabulary, which the healthy gear does not have.
    freedom : int
        Complex numbers that are left of the recordings of one line.
    """

    channels: tuple[str, ...]
    lines: Complex[np.ndarray, "order channel recording"]
    laws: Float[np.ndarray, "order channel recording law"]
    freedom: int

    def strongest(self, level: float, described: Sequence[Described]) -> Described | None:
        """The significant regularity with the largest gain, without orders and patterns that were described before."""
        along = np.einsum("kcr,kcrl->ckl", self.lines, self.laws)
        whole = (np.abs(self.lines) ** 2).sum(axis=-1).T[..., None]
        seen = (self.laws**2).sum(axis=2).swapaxes(0, 1)
        shown = [name for name, pattern in PATTERNS.items() if set(pattern) <= set(self.channels)]
        found: list[Described] = []
        for name in shown:
            own, weights = self._of(name)
            square = np.tensordot(np.abs(weights) ** 2, seen[own], 1)
            size = np.tensordot(weights.conj(), along[own], 1) / np.maximum(square, 1e-300)
            gain = np.abs(size) ** 2 * square
            rest = whole[own].sum(axis=0) - gain
            _, p_value = f_test(gain, 2.0, rest, 2.0 * (self.freedom * len(own) - 1))
            chance = np.minimum(1.0, len(shown) * gain.size * p_value)
            for k, law in zip(*np.nonzero(chance <= level), strict=True):
                atom = Atom(int(k) + ORDERS + 1, name, list(LAWS)[law])
                amplitude, phase = float(abs(size[k, law])), float(-np.angle(size[k, law]))
                found.append(Described(atom, float(gain[k, law]), 2, amplitude, phase, float(chance[k, law])))
        known = {(each.atom.order, each.atom.pattern) for each in described}
        new = [each for each in found if (each.atom.order, each.atom.pattern) not in known]
        best = max(new, key=lambda each: each.gain, default=None)
        return best and replace(best, rivals=other_laws(best, new))

    def without(self, found: Described) -> "Above":
        """The lines without a regularity."""
        own, weights = self._of(found.atom.pattern)
        at, law = found.atom.order - ORDERS - 1, list(LAWS).index(found.atom.law)
        lines = self.lines.copy()
        size = found.amplitude * np.exp(-1j * found.phase)
        lines[at, own] -= size * weights[:, None] * self.laws[at, own, :, law]
        return replace(self, lines=lines)

    def _of(self, pattern: str) -> tuple[list[int], np.ndarray]:
        """The channels of a pattern, by number, and their weights."""
        weights = PATTERNS[pattern]
        return [self.channels.index(channel) for channel in weights], np.array(list(weights.values()))


def high_order_regularities(
    recordings: Sequence[Recording], healthy: Sequence[Recording], before: Model, after: Model, level: float, most: int
) -> tuple[Described, ...]:
    """Regularities that neither a model nor the healthy gear has, the strongest first.

    Parameters
    ----------
    recordings : sequence of Recording
    healthy : sequence of Recording
        Of the same gear, from its commissioning; may be none.
    before, after : Model
        Of the healthy gear, and with what was found.
    level : float
        Probability of a false one.
    most : int
        Largest number of regularities.
    """
    left = residual_lines(recordings, healthy, before, after)
    found: list[Described] = []
    while len(found) < most and (best := left.strongest(level, found)):
        found.append(best)
        left = left.without(best)
    return tuple(found)


def residual_lines(recordings: Sequence[Recording], healthy: Sequence[Recording], before: Model, after: Model) -> Above:
    """The remainder of the lines; parameters as of :func:`high_order_regularities`."""
    every, count = (*recordings, *healthy), len(recordings)
    channels, highest = layout_of(every).channels, min(HIGHEST_ORDER, int(min(map(samples_per_turn, every)) / 2) - 1)
    known = _modelled(before, every, channels, highest)
    now = _modelled(after, recordings, channels, highest)
    # What was found may be as much sharper than the library has it as its form is open at the lower orders.
    changed = np.zeros(known.shape[1:])
    changed[:, :count] = np.abs(now - known[..., :count])[1:].max(axis=0)
    modelled = np.concatenate([now, known[..., count:]], axis=-1)
    left = (_lines(every, channels, highest) - modelled)[ORDERS + 1 :]
    # The bench may be noisier than it was in commissioning.
    sessions = [_variance(each, channels, highest) for each in (recordings, healthy) if each]
    noise = np.concatenate(sessions, axis=-1)[ORDERS + 1 :]
    noise = noise * _narrow_bands(left[..., count:] / np.sqrt(noise[..., count:]), every, count, channels, highest)
    followed = np.array([laws(np.array(each.point.T_out), each.point.n_in_rpm) for each in every])
    own = left[..., count:] @ (followed @ np.linalg.pinv(followed[count:])).T if healthy else np.zeros(left.shape)
    doubt = LINE_TOLERANCE * (np.abs(modelled[ORDERS + 1 :]) + np.abs(own)) + FORM_TOLERANCE * changed
    scale = 1 / np.sqrt(noise + doubt**2)
    # Healthy recordings do not contain the effect; they show the normal dependence of the gear on load and speed.
    sought = np.array([[law(each.point, each.conditions) for law in LAWS.values()] for each in every])
    sought[count:] = 0.0
    U, s, _ = svd(followed)
    anyway = np.linalg.qr(scale[..., None] * U[:, s > RANK * s[0]])[0] if healthy else np.zeros((*scale.shape, 0))
    lines, asked_for = (scale * left)[..., None], scale[..., None] * sought
    return Above(
        channels, _without(anyway, lines)[..., 0], _without(anyway, asked_for), len(every) - anyway.shape[-1]
    )  # fmt: skip


def _narrow_bands(
    healthy: Complex[np.ndarray, "order channel healthy"], every: Sequence[Recording], count: int,
    channels: Sequence[str], highest: int,
) -> Float[np.ndarray, "order channel recording"]:  # fmt: skip
    """Factors on the variance of lines in narrow bands: as of the pattern over the gauges that has most of it.

    Parameters
    ----------
    healthy : array (order, channel, healthy)
        Lines in standard deviations of the smooth noise.
    every : sequence of Recording
        All recordings, those of the healthy gear after so many others.
    """
    frequency = frequencies([each.point for each in every], ORDERS + 1, highest)
    factors, groups = np.ones((frequency.shape[1], len(channels), len(every))), groups_of(every[count:])
    lines = about_mean(healthy.transpose(2, 1, 0), groups)
    for band in narrow_bands(lines, frequency[count:], freedom(groups), channels):
        recordings, orders = np.nonzero(frequency == band.frequency)
        factors[orders[:, None], [channels.index(name) for name in band.channels], recordings[:, None]] = band.largest
    return factors


def _without(Q: Float[np.ndarray, "*batch row direction"], columns: np.ndarray) -> np.ndarray:
    """Columns without their part along orthonormal directions."""
    return columns - Q @ (Q.swapaxes(-1, -2) @ columns)


def _modelled(
    model: Model, recordings: Sequence[Recording], channels: Sequence[str], highest: int
) -> Complex[np.ndarray, "order channel recording"]:
    """The lines of a model for every recording."""
    runs, of_recording = distinct([model.run(Situation(each.point, each.conditions)) for each in recordings])
    return _lines(simulate_turns(runs, revolutions=1, points=SAMPLES_PER_TURN), channels, highest)[..., of_recording]


def _lines(
    recordings: Sequence[Recording], channels: Sequence[str], highest: int
) -> Complex[np.ndarray, "order channel recording"]:
    """Complex order lines from 0 on, as of :meth:`Layout.lines`."""
    found = []
    for each in recordings:
        values = np.stack([each.channels[name] for name in channels], axis=1)
        cosine, sine = np.split(np.linalg.lstsq(basis(each.channels["phi_in"], highest), values)[0], [highest + 1])
        found.append(np.concatenate([cosine[:1], cosine[1:] - 1j * sine]))
    return np.stack(found, axis=-1)


def _variance(
    recordings: Sequence[Recording], channels: Sequence[str], highest: int
) -> Float[np.ndarray, "order channel recording"]:
    """Variance of a part of every line, by noise and by the resolution of the channels."""
    noise = floors(recordings, Layout(tuple(channels)))
    found = []
    for each in recordings:
        frequency = np.arange(highest + 1) * each.point.n_in_rpm / 60
        by_noise = np.array([floor.at(frequency) for floor in noise]) * 2 / len(each.time)
        ripple = np.array([each.channels[name].std() for name in channels])
        found.append(by_noise.T + (RESOLVED * ripple) ** 2)
    return np.stack(found, axis=-1)
